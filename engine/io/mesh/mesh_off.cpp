// Object File Format: OFF with optional normals and colours (NOFF, COFF, CNOFF, STOFF), in text.
#include <string>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {
namespace {

/// Data of a vertex after its position, by the keyword's prefix.
struct OffLayout {
  bool texture = false, color = false, normal = false;
};

OffLayout layout_of(std::string_view word, const MeshText& text) {
  OffLayout layout;
  std::string upper(word);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  std::string_view keyword = upper;
  const auto take = [&](std::string_view prefix) {
    if (!keyword.starts_with(prefix)) return false;
    keyword.remove_prefix(prefix.size());
    return true;
  };
  layout.texture = take("ST");
  layout.color = take("C");
  layout.normal = take("N");
  layout.color = layout.color || take("C");  // in either order
  if (keyword != "OFF") {
    text.fail("not an OFF file of points in space: it must begin with OFF, COFF, NOFF or STOFF");
  }
  return layout;
}

std::size_t to_count(std::string_view word, const MeshText& text, const MeshSource& source) {
  const std::int64_t count = text.to_integer(word);
  // A vertex, face or corner takes at least two characters.
  if (count < 0 || static_cast<std::size_t>(count) > source.bytes.size() / 2) {
    text.fail("a count of " + std::to_string(count) +
              " is more than the file can hold: it is cut short or corrupt");
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

RawMesh read_off(const MeshSource& source) {
  MeshText text(source);
  text.require_line("header");
  std::string_view first = text.word();
  OffLayout layout;
  if (first.front() < '0' || first.front() > '9') {  // some files begin with the counts
    layout = layout_of(first, text);
    first = text.word();
  }
  if (first == "BINARY") text.fail("binary OFF is not read: save it as text, or as PLY");
  if (first.empty()) {
    text.require_line("counts");
    first = text.word();
  }
  const std::size_t vertex_count = to_count(first, text, source);
  const std::size_t face_count = to_count(text.word(), text, source);

  RawMesh mesh;
  std::vector<Vec3f> normals;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    text.require_line("vertices");
    mesh.vertices.push_back(text.point());
    if (layout.normal) normals.push_back(text.point_or_nan().cast<float>());
  }
  std::vector<std::uint32_t> polygon;
  for (std::size_t f = 0; f < face_count; ++f) {
    text.require_line("faces");
    polygon.clear();
    for (std::size_t i = 0, n = to_count(text.word(), text, source); i < n; ++i) {
      const std::int64_t v = text.integer();
      if (v < 0 || static_cast<std::size_t>(v) >= vertex_count) {
        text.fail("there is no vertex " + std::to_string(v) + " among " +
                  std::to_string(vertex_count) + ": export the mesh again");
      }
      polygon.push_back(static_cast<std::uint32_t>(v));
    }
    add_polygon(mesh, polygon);
  }
  spread_to_corners(mesh, normals, {});
  return mesh;
}

}  // namespace sunder
