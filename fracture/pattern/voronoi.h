// Voronoi cells by clipping: each cell is a solid cut by the bisectors of its site with other
// sites, nearest first, until no farther site can reach it.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fracture {

/// Returns the cells of `sites` within `solid`, in the order of the sites; a cell outside `solid`
/// is empty. Appends new planes to `planes`, one per pair of adjacent cells; face ids are those of
/// pattern_plane().
std::vector<ConvexPolyhedron> voronoi_cells(std::span<const Vec3> sites,
                                            const ConvexPolyhedron& solid,
                                            std::vector<Plane>& planes);

}  // namespace sunder::fracture
