// Step 2 of a fracture for convexes with a visual mesh, which is cut with them (paper 3.3).
#pragma once

#include "fracture/cut/intersect.h"

namespace sunder::fracture {

/// Cuts a surface convex by all cells. Each island of its mesh in a cell gets a convex, fitted to
/// it within the cell; a part that lies inside the mesh becomes an internal convex. Runs in
/// parallel.
Intersection intersect_surface(const AlignedPattern& pattern, const ConvexPtr& convex,
                               const Fit& fit);

/// Returns `region` clipped to fit the points in it (paper 3.3 c); new faces have no id. Faces that
/// the points touch are kept, and so are contacts in them.
ConvexPolyhedron fit_to_points(const ConvexPolyhedron& region, std::span<const Vec3> points,
                               const Fit& fit);

}  // namespace sunder::fracture
