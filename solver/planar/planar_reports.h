// What Box2D's contacts are after its last step, for statistics and debug views.
#pragma once

#include <span>
#include <vector>

#include "solver/planar/planar_bodies.h"

namespace sunder::solver {

/// See Physics::penetrations().
std::vector<float> find_penetrations(const b2World& world, const Plane2& plane);
/// See Physics::inspect(); `h_s` is that of the last step, 0: there was none.
PhysicsInspection inspect_planar(const b2World& world, std::span<const PlanarBody> bodies,
                                 const Plane2& plane, double h_s);

}  // namespace sunder::solver
