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

/// The outer contours of a polygon, counter-clockwise, and its holes, clockwise.
using Contours = std::span<const std::span<const Vec2>>;
/// Area that any two polygons have in common; contours of which every corner has one of the other
/// within `near` are the same. It changes as little as the polygons do, even where edges coincide
/// but for rounding.
double overlap_area(Contours a, Contours b, double near);

/// Distance from a point to a convex solid; 0 inside.
double distance(const Vec3& point, const ConvexPolyhedron& convex);

}  // namespace sunder::fracture
