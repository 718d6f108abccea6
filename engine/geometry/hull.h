// Convex hulls, for preparation.
#pragma once

#include <span>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// The convex hull of points in general or degenerate position (coplanar faces merged),
/// flat-shaded. Empty if the points span no volume. For preparation, not for run time: clipping
/// knows the topology already.
ConvexPolyhedron make_hull(std::span<const Vec3> points);

}  // namespace sunder
