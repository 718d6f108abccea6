// Voronoi cells by clipping: each cell is a solid cut by the bisectors of its site with the
// others, nearest first, until no farther site can matter.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fracture {

/// The cells of `sites` within `solid`, in the order of the sites; empty where a site's cell lies
/// outside of it. New planes are appended to `planes`, one a pair of cells that meet; faces name
/// them as pattern_plane() does.
std::vector<ConvexPolyhedron> voronoi_cells(std::span<const Vec3> sites,
                                            const ConvexPolyhedron& solid,
                                            std::vector<Plane>& planes);

}  // namespace sunder::fracture
