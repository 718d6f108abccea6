// What touches, or would within a step: for those who ask before the solve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// Contact points of two fixtures.
struct Nearby {
  std::uint64_t key_a = 0, key_b = 0;      ///< Of the fixtures.
  std::uint32_t body_a = 0, body_b = 0;    ///< Slots.
  std::uint32_t shape_a = 0, shape_b = 0;  ///< Slots.
  Vec3 normal_W = Vec3::UnitY();           ///< Unit, from a to b.
  int count = 0;
  Vec3 points_W[2];  ///< In the middle of the gap; at z = 0.
  double separations_m[2] = {};
};

/// All that are near enough to touch within dt_s as they move now; in order of keys.
std::vector<Nearby> find_nearby(const b2World& world, std::span<const PlanarBody> bodies,
                                std::span<const PlanarShape> shapes, const Plane2& plane,
                                double dt_s);

}  // namespace sunder::solver
