// Any bytes as a mesh of FUZZED_FORMAT: reading ends with a mesh whose every corner names a vertex,
// or with an InputError.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "engine/base/check.h"
#include "engine/io/mesh/mesh_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Small limits keep the fuzzer fast; they are input like any other.
  const sunder::MeshLimits limits{.bytes = 1 << 20, .vertices = 1 << 16, .corners = 1 << 18};
  try {
    const sunder::RawMesh mesh =
        sunder::parse_mesh(std::as_bytes(std::span(data, size)), sunder::MeshFormat::FUZZED_FORMAT,
                           "no_such_folder/mesh", limits);
    for (const std::uint32_t v : mesh.corners) SUNDER_CHECK(v < mesh.vertices.size());
    for (const sunder::Vec3& p : mesh.vertices) SUNDER_CHECK(p.allFinite());
    SUNDER_CHECK(mesh.corner_normals.empty() || mesh.corner_normals.size() == mesh.corners.size());
    SUNDER_CHECK(mesh.corner_uvs.empty() || mesh.corner_uvs.size() == mesh.corners.size());
  } catch (const sunder::InputError&) {
  }
  return 0;
}
