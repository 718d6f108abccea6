// The outer surface of solids that share walls: faces that two of them have in common are removed.
//
// Read first: outer_surface(). A face of one solid that covers part of a face of another is cut, so
// that every edge of the result lies in exactly two faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Closed surfaces without walls between them.
struct OuterSurface {
  PolygonMesh mesh;                 ///< Caps need not follow the other faces.
  std::vector<std::uint32_t> from;  ///< For each face, the number of the mesh that it is of.
};

/// Removes what faces with opposite names of different meshes have in common. Each directed edge of
/// the result has its opposite exactly once, by the numbers of its vertices. Where the surface
/// touches itself, vertices in one place have several numbers, and an edge is divided in another
/// place for each two faces. The
/// enclosed volume is the sum of the volumes of the meshes within 1e-12 of it. Returns none where
/// that cannot be reached.
std::optional<OuterSurface> outer_surface(std::span<const PolygonMesh* const> meshes);

/// Several closed meshes as one, walls and all.
OuterSurface side_by_side(std::span<const PolygonMesh* const> meshes);

/// Changes a surface so that, once its faces are triangles, every edge lies in two of them by the
/// places of its ends, as programs see it that join vertices in one place: edges that more than two
/// share are divided, in another place for each two. What touches nowhere stays as it is.
void separate_triangles(OuterSurface& outer);

}  // namespace sunder
