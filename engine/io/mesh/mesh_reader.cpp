#include "engine/io/mesh/mesh_reader.h"

#include <algorithm>
#include <map>

#include "engine/io/bytes.h"
#include "engine/io/mesh/mesh_text.h"

namespace sunder {
namespace {

/// Larger coordinates (in metres) are invalid or would overflow in later computations.
constexpr double kMaxCoordinate_m = 1e9;

const std::map<std::string, MeshFormat>& formats() {
  static const std::map<std::string, MeshFormat> by_extension = {
      {".obj", MeshFormat::kObj}, {".ply", MeshFormat::kPly},   {".stl", MeshFormat::kStl},
      {".off", MeshFormat::kOff}, {".gltf", MeshFormat::kGltf}, {".glb", MeshFormat::kGltf}};
  return by_extension;
}

MeshFormat format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  const auto found = formats().find(extension);
  if (found == formats().end()) {
    throw InputError(file.string() +
                     ": unsupported mesh format; use .obj, .ply, .stl, .off, .gltf or .glb");
  }
  return found->second;
}

RawMesh read_as(MeshFormat format, const MeshSource& source) {
  switch (format) {
    case MeshFormat::kObj:
      return read_obj(source);
    case MeshFormat::kPly:
      return read_ply(source);
    case MeshFormat::kStl:
      return read_stl(source);
    case MeshFormat::kOff:
      return read_off(source);
    case MeshFormat::kGltf:
      return read_gltf(source);
  }
  source.fail("unknown format");
}

template <class Attribute>
void drop_if_zero(std::vector<Attribute>& attributes) {
  if (std::all_of(attributes.begin(), attributes.end(),
                  [](const Attribute& a) { return !(a.squaredNorm() > 0); })) {
    attributes.clear();
  }
}

/// Checks the requirements of RawMesh and replaces invalid normals and texture coordinates by 0.
void check(RawMesh& mesh, const MeshSource& source) {
  source.check_size(mesh);
  if (mesh.polygons.empty()) {
    source.fail("the file has no faces; export polygons, not points or curves");
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    // maxCoeff() could ignore NaN.
    if (!(mesh.vertices[v].array().abs() <= kMaxCoordinate_m).all()) {
      source.fail("vertex " + std::to_string(v + 1) +
                  " is not within 1e9 m of the origin; scale the mesh, or move it");
    }
  }
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    for (const std::uint32_t v : mesh.polygon_corners(p)) {
      if (v < mesh.vertices.size()) continue;
      source.fail("face " + std::to_string(p + 1) + " has a corner at vertex " +
                  std::to_string(v + 1) + " of " + std::to_string(mesh.vertices.size()) +
                  "; export the mesh again");
    }
  }
  for (Vec3f& n : mesh.corner_normals) {
    if (!n.allFinite()) n.setZero();
  }
  for (Vec2f& uv : mesh.corner_uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  drop_if_zero(mesh.corner_normals);
  drop_if_zero(mesh.corner_uvs);
}

}  // namespace

RawMesh parse_mesh(std::span<const std::byte> bytes, MeshFormat format,
                   const std::filesystem::path& file, const MeshLimits& limits) {
  const MeshSource source{
      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, limits};
  if (bytes.size() > limits.bytes) {
    source.fail("the file is larger than " + std::to_string(limits.bytes) +
                " bytes; simplify the mesh");
  }
  RawMesh mesh = read_as(format, source);
  check(mesh, source);
  return mesh;
}

RawMesh read_mesh(const std::filesystem::path& file, const MeshLimits& limits) {
  const MeshFormat format = format_of(file);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(file.string() + ": there is no such file; check the name");
  }
  if (std::filesystem::file_size(file, error) > limits.bytes) {
    throw InputError(file.string() + ": the file is larger than " + std::to_string(limits.bytes) +
                     " bytes; simplify the mesh");
  }
  return parse_mesh(read_file(file, file_kinds::kMesh), format, file, limits);
}

}  // namespace sunder
