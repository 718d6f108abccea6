// The end of repair: closed shells that face outward, as polygon meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/repair/surface.h"

namespace sunder {

/// The polygons for which `keep` is not zero.
RawMesh extract(const RawMesh& mesh, const std::vector<std::uint8_t>& keep);
/// Appends `other`, whose polygons get no group of their own and no attributes.
void append(RawMesh& mesh, const RawMesh& other);
/// Replaces polygons whose corners lie in no plane by triangles; returns how many.
std::size_t triangulate_curved(RawMesh& mesh);
/// Flips shells that face inward, save cavities in others; returns how many. `solid` becomes the
/// number of each polygon's solid, a shell with its cavities; `count` how many solids there are.
std::size_t face_outward(Surface& surface, std::vector<std::uint32_t>& solid, std::uint32_t& count);
/// A mesh per solid, with shading normals.
std::vector<PolygonMesh> polygon_meshes(const Surface& surface,
                                        const std::vector<std::uint32_t>& solid,
                                        std::uint32_t count, double crease_cosine);

}  // namespace sunder
