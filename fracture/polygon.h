// Flat polygons: how much two of them overlap, and how far a point is from a convex solid.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder::fracture {

/// Signed area: positive counter-clockwise.
double polygon_area(std::span<const Vec2> polygon);

/// Reused memory of overlap_area().
struct OverlapScratch {
  std::vector<Vec2> current, next;
};
/// Area that two convex counter-clockwise polygons have in common (Sutherland and Hodgman 1974).
double overlap_area(std::span<const Vec2> a, std::span<const Vec2> b, OverlapScratch& scratch);

/// Distance from a point to a convex solid; 0 inside.
double distance(const Vec3& point, const ConvexPolyhedron& convex);

}  // namespace sunder::fracture
