// Area vectors of polygons in space.
#pragma once

#include <cstdint>
#include <span>

#include "engine/base/types.h"

namespace sunder {

/// Returns twice the area of a polygon times its unit normal (Newell), in m², summed over the
/// triangle fan of its first corner. `corners` are at least three indices of vertices.
inline Vec3 double_area(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners) {
  const Vec3& apex = vertices[corners[0]];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += (vertices[corners[i - 1]] - apex).cross(vertices[corners[i]] - apex);
  }
  return sum;
}

}  // namespace sunder
