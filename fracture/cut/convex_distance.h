// Distance of a point from a convex polyhedron.
#pragma once

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fracture {

/// Returns the distance from a point to a convex polyhedron, in metres; 0 inside.
double distance(const Vec3& point, const ConvexPolyhedron& convex);

}  // namespace sunder::fracture
