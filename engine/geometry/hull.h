// Exact convex hulls of points.
#pragma once

#include <span>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Returns the flat-shaded convex hull of points, which may be in degenerate position; coplanar
/// faces are merged. Empty if the points span no volume. Meant for the preparation of scenes:
/// breaks use clip(), which need not find the topology anew.
ConvexPolyhedron make_hull(std::span<const Vec3> points);

}  // namespace sunder
