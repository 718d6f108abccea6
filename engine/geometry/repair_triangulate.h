// Triangles over one contour in space: for polygons that are not planar, and for holes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles (indices into `contour`) with the contour's sense, always contour.size() - 2 of them.
/// Of least area for contours of up to kLeastAreaCorners corners, else clipped ear by ear.
std::vector<Triangle> triangulate(std::span<const Vec3> contour);

inline constexpr std::size_t kLeastAreaCorners = 128;

}  // namespace sunder
