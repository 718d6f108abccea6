// Where the nodes of a decomposition go by themselves: the sites of its Voronoi cells, which the
// paper places by hand, leaving the rest open (end of 4.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// Points spread evenly over a mesh's surface, in the order of its faces.
std::vector<Vec3> surface_samples(const PolygonMesh& mesh, std::size_t count);

/// Up to `count` nodes: the means of as many clusters of the surface (Lloyd 1982).
std::vector<Vec3> automatic_nodes(const PolygonMesh& mesh, std::uint32_t count);

/// How many of `count` nodes each shell gets: one, and the others by how far the shells are from
/// convex, or by volume where all are convex.
std::vector<std::uint32_t> share_nodes(std::span<const PolygonMesh> shells, std::uint32_t count);

}  // namespace sunder::fracture
