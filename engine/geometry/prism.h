// Convex outlines of points, and prisms along z, which planar scenes simulate by their outlines.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Returns the convex hull of points in a plane, counter-clockwise (monotone chain, Andrew 1979).
/// Corners within `tolerance_m` of the line between their neighbours are left out.
std::vector<Vec2> convex_outline(std::vector<Vec2> points, double tolerance_m);

/// The prism over a convex polygon in the xy-plane, from `low` to `high` along z, in metres.
struct ZPrism {
  std::vector<Vec2> outline;  ///< Counter-clockwise seen from +z, without collinear corners.
  double low = 0, high = 0;
};

/// Returns a convex with the pose X_WR as a prism along z; none if a face normal is neither
/// parallel nor perpendicular to z within 1e-6, or if the outline is degenerate.
std::optional<ZPrism> prism_along_z(const ConvexPolyhedron& convex, const Pose& X_WR);

}  // namespace sunder
