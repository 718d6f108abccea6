// Fuzz targets: any bytes as a mesh file of each format give a mesh whose corners are indices of
// vertices, or an InputError.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "engine/base/check.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

template <MeshFormat format>
void read(std::span<const std::uint8_t> bytes) {
  // Small limits keep the fuzzer fast.
  const MeshLimits limits{.bytes = 1 << 20, .vertices = 1 << 16, .corners = 1 << 18};
  try {
    const RawMesh mesh = parse_mesh(std::as_bytes(bytes), format, "no_such_folder/mesh", limits);
    for (const std::uint32_t v : mesh.corners) SUNDER_CHECK(v < mesh.vertices.size());
    for (const Vec3& p : mesh.vertices) SUNDER_CHECK(p.allFinite());
    SUNDER_CHECK(mesh.corner_normals.empty() || mesh.corner_normals.size() == mesh.corners.size());
    SUNDER_CHECK(mesh.corner_uvs.empty() || mesh.corner_uvs.size() == mesh.corners.size());
  } catch (const InputError&) {
  }
}

const fuzz::Registration mesh_targets[] = {{"mesh_obj", read<MeshFormat::kObj>},
                                           {"mesh_ply", read<MeshFormat::kPly>},
                                           {"mesh_stl", read<MeshFormat::kStl>},
                                           {"mesh_off", read<MeshFormat::kOff>},
                                           {"mesh_gltf", read<MeshFormat::kGltf>}};

}  // namespace
}  // namespace sunder
