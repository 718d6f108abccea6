#include "fracture/adjacency/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder::fracture {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double square_distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - (from + t * along)).squaredNorm();
}

/// Squared distance to a face that the point is above.
double square_distance_to_face(const Vec3& point, const ConvexPolyhedron& convex, std::size_t f) {
  const std::span<const std::uint32_t> corners = convex.face_corners(f);
  const Plane& plane = convex.faces[f].plane;
  double square = std::numeric_limits<double>::infinity();
  bool is_within = true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& from = convex.vertices[corners[i]];
    const Vec3& to = convex.vertices[corners[(i + 1) % corners.size()]];
    is_within &= plane.normal.dot((to - from).cross(point - from)) >= 0;
    square = std::min(square, square_distance_to_segment(point, from, to));
  }
  const double height = plane.distance(point);
  return is_within ? height * height : square;
}

}  // namespace

double polygon_area(std::span<const Vec2> polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * twice;
}

double overlap_area(std::span<const Vec2> a, std::span<const Vec2> b, OverlapScratch& scratch) {
  std::vector<Vec2>& current = scratch.current;
  std::vector<Vec2>& next = scratch.next;
  current.assign(a.begin(), a.end());
  for (std::size_t e = 0; e < b.size(); ++e) {
    const Vec2& start = b[e];
    const Vec2 along = b[e + 1 < b.size() ? e + 1 : 0] - start;
    next.clear();
    double before = cross(along, current.back() - start);
    Vec2 from = current.back();
    for (const Vec2& to : current) {
      const double after = cross(along, to - start);
      if ((before < 0) != (after < 0))
        next.push_back(from + before / (before - after) * (to - from));
      if (after >= 0) next.push_back(to);
      before = after;
      from = to;
    }
    if (next.size() < 3) return 0;
    std::swap(current, next);
  }
  return std::max(0.0, polygon_area(current));
}

double distance(const Vec3& point, const ConvexPolyhedron& convex) {
  double square = std::numeric_limits<double>::infinity();
  bool is_inside = true;
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    if (convex.faces[f].plane.distance(point) <= 0) continue;
    is_inside = false;
    square = std::min(square, square_distance_to_face(point, convex, f));
  }
  return is_inside ? 0 : std::sqrt(square);
}

}  // namespace sunder::fracture
