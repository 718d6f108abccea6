// Contacts between fixtures, including speculative ones, before the solve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// Contact of two fixtures, with one or two points.
struct FixtureContact {
  std::uint32_t body_a = 0, body_b = 0;    ///< Slots of the bodies.
  std::uint32_t shape_a = 0, shape_b = 0;  ///< Slots of the shapes.
  Vec3 normal_W = Vec3::UnitY();           ///< Unit normal from a to b.
  int count = 0;                           ///< Number of points.
  Vec3 points_W[2];                        ///< Midpoints of the gap, at z = 0.
  double separations_m[2] = {};
};

/// Returns all contacts that may close within dt_s at current velocities, in order of the
/// keys of their fixtures.
std::vector<FixtureContact> find_fixture_contacts(const b2World& world,
                                                  std::span<const PlanarBody> bodies,
                                                  std::span<const PlanarShape> shapes,
                                                  const Plane2& plane, double dt_s);

}  // namespace sunder::solver
