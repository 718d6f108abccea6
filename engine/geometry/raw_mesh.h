// A mesh as a file gives it: polygons that may be open, duplicate, flipped or degenerate.
// engine/geometry/repair/repair.h makes watertight PolygonMeshes of it, which can be broken.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Polygons of one contour each. All vertex indices are valid; nothing else is guaranteed.
struct RawMesh {
  struct Polygon {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    std::uint32_t group = kNoGroup;  ///< Index into `groups`.
  };
  /// Polygons of a file that have their names and their appearance in common.
  struct Group {
    std::vector<std::string> names;  ///< Narrowest first: group, object, material.
    std::optional<Appearance> appearance =
        std::nullopt;  ///< None if the file defines no appearance.
  };
  static constexpr std::uint32_t kNoGroup = ~std::uint32_t{0};

  std::vector<Vec3> vertices;
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> corners;  ///< Vertex index of each corner.
  std::vector<Vec3f> corner_normals;  ///< Zero for corners without one; empty if the file has none.
  std::vector<Vec2f> corner_uvs;  ///< Zero for corners without ones; empty if the file has none.
  std::vector<Group> groups;
  /// Missing files that the mesh file refers to: images and material libraries.
  std::vector<std::string> missing_files;

  std::span<const std::uint32_t> polygon_corners(std::size_t p) const {
    return std::span(corners).subspan(polygons[p].first_corner, polygons[p].corner_count);
  }
};

}  // namespace sunder
