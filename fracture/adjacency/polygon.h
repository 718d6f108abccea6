// Convex polygons in a plane, and how much two of them overlap.
#pragma once

#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::fracture {

/// Signed area: positive counter-clockwise.
double polygon_area(std::span<const Vec2> polygon);

/// Reused memory of overlap_area().
struct OverlapScratch {
  std::vector<Vec2> current, next;
};
/// Area that two convex counter-clockwise polygons have in common (Sutherland and Hodgman 1974).
double overlap_area(std::span<const Vec2> a, std::span<const Vec2> b, OverlapScratch& scratch);

}  // namespace sunder::fracture
