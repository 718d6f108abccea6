// Automatic placement of the nodes of a decomposition, which are the sites of its Voronoi cells.
// The paper places nodes by hand and leaves automatic placement open (end of 4.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// Returns `count` points evenly distributed over a mesh's surface, in the order of its faces.
std::vector<Vec3> surface_samples(const PolygonMesh& mesh, std::size_t count);

/// Returns up to `count` nodes: the means of clusters of surface points (Lloyd 1982).
std::vector<Vec3> automatic_nodes(const PolygonMesh& mesh, std::uint32_t count);

/// Returns the number of nodes per shell, `count` in total: one each, and the others in proportion
/// to concavity, or to volume if all shells are convex.
std::vector<std::uint32_t> share_nodes(std::span<const PolygonMesh> shells, std::uint32_t count);

}  // namespace sunder::fracture
