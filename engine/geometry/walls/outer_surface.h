// The outer surface of solids that touch face to face: the common parts of their faces (walls) are
// removed.
//
// Begin with outer_surface(). A face that partly covers a face of another solid is cut, so that
// every edge of the result belongs to exactly two faces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// The merged surface of several closed meshes.
struct OuterSurface {
  PolygonMesh mesh;                 ///< Caps need not come after the other faces.
  std::vector<std::uint32_t> from;  ///< Index of the input mesh of each face.
};

/// Returns the surface of several meshes without the common parts of faces that have opposite ids
/// and belong to different meshes. Each directed edge has its opposite exactly once, by the indices
/// of its vertices. Where the surface touches itself, there are several vertices at one position,
/// and a common edge is divided at a different point for each pair of faces. The volume is the sum
/// of the meshes' volumes within 1e-12 of it. Returns none if no such surface is found.
std::optional<OuterSurface> outer_surface(std::span<const PolygonMesh* const> meshes);

/// Returns several closed meshes as one, with the walls between them.
OuterSurface concatenate_meshes(std::span<const PolygonMesh* const> meshes);

/// Triangulates a surface so that no triangle has equal corners and every edge belongs to two
/// triangles also after vertices at equal positions are welded. Points that differ by rounding
/// errors are joined; edges of more than two triangles are divided, at a different point for each
/// pair. A surface whose triangles are so already is left unchanged.
void make_triangles_manifold(OuterSurface& outer);

}  // namespace sunder
