#include "fracture/cut/convex_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace sunder::fracture {
namespace {

double square_distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - (from + t * along)).squaredNorm();
}

/// Returns the squared distance to a face that the point is above.
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
