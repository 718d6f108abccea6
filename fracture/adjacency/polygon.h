// Convex polygons in a plane: area and overlap.
#pragma once

#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::fracture {

/// Returns the signed area, which is positive if counter-clockwise.
double polygon_area(std::span<const Vec2> polygon);

/// Reused memory of overlap_area().
struct OverlapScratch {
  std::vector<Vec2> current, next;
};
/// Returns the overlap of two convex counter-clockwise polygons (Sutherland and Hodgman 1974).
double overlap_area(std::span<const Vec2> a, std::span<const Vec2> b, OverlapScratch& scratch);

}  // namespace sunder::fracture
