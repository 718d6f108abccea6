// Step 2 of a fracture for convexes that own a visual mesh: the mesh is cut with them (paper 3.3).
#pragma once

#include "fracture/cut/intersect.h"

namespace sunder::fracture {

/// Cuts a surface convex by all cells. Each island of its mesh in a cell gets a convex of its own,
/// fitted to it within the cell; a part wholly inside the mesh becomes an internal convex.
/// Parallel.
Intersection intersect_surface(const AlignedPattern& pattern, const ConvexPtr& convex,
                               const Fit& fit);

/// `region` clipped to fit the points in it (paper 3.3 c); new faces have no names. Faces that
/// the points touch stay, so that neighbours do.
ConvexPolyhedron refitted(const ConvexPolyhedron& region, std::span<const Vec3> points,
                          const Fit& fit);

}  // namespace sunder::fracture
