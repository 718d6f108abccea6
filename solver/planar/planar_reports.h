// Reports on Box2D's contacts after its last step, for statistics and debug views.
#pragma once

#include <span>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// Implements Physics::penetrations().
std::vector<float> find_penetrations(const b2World& world, const Plane2& plane);
/// Implements Physics::contact_forces(); `h_s` is the duration of Box2D's last step, 0 before the
/// first.
std::vector<ContactForce> find_contact_forces(const b2World& world,
                                              std::span<const PlanarBody> bodies,
                                              const Plane2& plane, double h_s);
/// Implements Physics::inspect().
PhysicsInspection inspect_planar(std::span<const PlanarBody> bodies, const Plane2& plane);

}  // namespace sunder::solver
