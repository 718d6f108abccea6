// Triangulation of one contour in space, for non-planar polygons and for holes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Three indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Returns contour.size() - 2 triangles of indices into `contour`, with the contour's orientation;
/// none for fewer than three corners. Contours of up to 64 corners get triangles of least area,
/// those of up to 2000 are ear-clipped, and larger ones get a fan, to bound the work per corner.
std::vector<Triangle> triangulate(std::span<const Vec3> contour);

}  // namespace sunder
