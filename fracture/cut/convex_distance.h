// How far a point is from a convex solid.
#pragma once

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fracture {

/// From a point to a convex solid, in metres; 0 inside.
double distance(const Vec3& point, const ConvexPolyhedron& convex);

}  // namespace sunder::fracture
