// STL, text or binary: triangles without shared vertices. Facet normals are ignored as redundant.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {
namespace {

constexpr std::size_t kHeaderBytes = 80, kTriangleBytes = 50;

/// Returns the number of triangles of a binary file; some writers leave the stored count 0.
std::size_t triangle_count(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes, sizeof count);
  return count > 0 ? count : (bytes.size() - kHeaderBytes - 4) / kTriangleBytes;
}

/// True for binary files. Many of these begin with "solid" as text files do, but only their count
/// has a byte 0.
bool is_binary(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes + 4 &&
         (bytes.size() - kHeaderBytes - 4) / kTriangleBytes >= triangle_count(bytes) &&
         (!bytes.starts_with("solid") ||
          bytes.substr(kHeaderBytes, 4).find('\0') != std::string_view::npos);
}

bool is_word(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return a == b || (a | 0x20) == b; });
}

RawMesh read_binary(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  RawMesh mesh;
  const char* triangle = bytes.data() + kHeaderBytes + 4;
  for (std::size_t t = 0, n = triangle_count(bytes); t < n; ++t, triangle += kTriangleBytes) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    float coordinates[9];
    std::memcpy(coordinates, triangle + 3 * sizeof(float), sizeof coordinates);
    for (int v = 0; v < 3; ++v) {
      mesh.vertices.push_back(Eigen::Map<const Vec3f>(coordinates + 3 * v).cast<double>());
    }
    add_polygon(mesh, std::array{first, first + 1, first + 2});
  }
  return mesh;
}

RawMesh read_text(const MeshSource& source) {
  RawMesh mesh;
  MeshText text(source);
  std::vector<std::uint32_t> polygon;
  bool any_keyword = false;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (is_word(keyword, "solid")) {
      mesh.groups.push_back({{std::string(text.word())}, {}});
      any_keyword = true;
    } else if (is_word(keyword, "vertex")) {
      polygon.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(text.point());
    } else if (is_word(keyword, "endloop")) {
      add_polygon(mesh, polygon);
      polygon.clear();
    }
  }
  if (!any_keyword) source.fail("not an STL file, or cut short: export the mesh again");
  if (!polygon.empty()) text.fail("the file ends within a facet: it is cut short");
  return mesh;
}

}  // namespace

RawMesh read_stl(const MeshSource& source) {
  return is_binary(source.bytes) ? read_binary(source.bytes) : read_text(source);
}

}  // namespace sunder
