// A mesh as a file gives it: polygons that may be open, doubled, flipped or degenerate. What can
// be broken is a PolygonMesh; engine/geometry/repair/repair.h makes one of the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Polygons with one contour each. Every corner names a vertex that exists; nothing else is sure.
struct RawMesh {
  struct Polygon {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    std::uint32_t group = kNoGroup;  ///< Index into `groups`.
  };
  /// What a file calls some of its polygons: their group, object and material, the narrower first.
  struct Group {
    std::vector<std::string> names;
    std::optional<Paint> paint = std::nullopt;  ///< None: the file does not say how it looks.
  };
  static constexpr std::uint32_t kNoGroup = ~std::uint32_t{0};

  std::vector<Vec3> vertices;
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> corners;  ///< Vertex index of each corner.
  std::vector<Vec3f> corner_normals;   ///< Zero where the file has none; empty if it has none.
  std::vector<Vec2f> corner_uvs;       ///< Likewise.
  std::vector<Group> groups;
  /// Files that the mesh names for its look and that are not there: pictures, lists of materials.
  std::vector<std::string> missing_files;

  std::span<const std::uint32_t> polygon_corners(std::size_t p) const {
    return std::span(corners).subspan(polygons[p].first_corner, polygons[p].corner_count);
  }
};

}  // namespace sunder
