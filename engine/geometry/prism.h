// Prisms along z, solids that a plane scene can stand for by their outline; and outlines.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// Convex hull of points in a plane, counter-clockwise (monotone chain, Andrew 1979). Corners less
/// than `tolerance_m` off the line between their neighbours are left out.
std::vector<Vec2> convex_outline(std::vector<Vec2> points, double tolerance_m);

/// A convex polygon in the xy-plane, swept from `low` to `high` along z.
struct ZPrism {
  std::vector<Vec2> outline;  ///< Counter-clockwise seen from +z, without needless corners.
  double low = 0, high = 0;
};

/// The convex, placed in W, as a prism along z; nothing if it is none within a millionth of its
/// size.
std::optional<ZPrism> prism_along_z(const ConvexPolyhedron& convex, const Pose& X_WR);

}  // namespace sunder
