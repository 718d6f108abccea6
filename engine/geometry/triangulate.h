// Triangles over one contour in space: for polygons that are not planar, and for holes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Three indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles (indices into `contour`) with the contour's sense, always contour.size() - 2 of them.
/// Of least area for contours of up to 64 corners, ear by ear up to 2000, else a fan: the work for
/// a corner is bounded.
std::vector<Triangle> triangulate(std::span<const Vec3> contour);

}  // namespace sunder
