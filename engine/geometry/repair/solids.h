// The end of repair: orients closed shells outward and makes polygon meshes of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/repair/surface.h"

namespace sunder {

/// Returns the polygons for which `keep` is not zero, with the vertices that they use.
RawMesh extract(const RawMesh& mesh, const std::vector<std::uint8_t>& keep);
/// Appends the polygons of `other`, without group, normals and texture coordinates.
void append(RawMesh& mesh, const RawMesh& other);
/// Replaces non-planar polygons by triangles. Returns the number of polygons replaced.
std::size_t triangulate_curved(RawMesh& mesh);
/// Flips shells that face inward and are not cavities. Returns the number of shells flipped.
/// `solid` becomes the number of each polygon's solid (shell with cavities), `count` that of
/// solids.
std::size_t orient_outward(Surface& surface, std::vector<std::uint32_t>& solid,
                           std::uint32_t& count);
/// Returns a mesh for each solid, with shading normals as of shading_normals().
std::vector<PolygonMesh> polygon_meshes(const Surface& surface,
                                        const std::vector<std::uint32_t>& solid,
                                        std::uint32_t count, double crease_cosine);

}  // namespace sunder
