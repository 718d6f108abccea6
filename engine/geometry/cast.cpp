#include "engine/geometry/cast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace sunder {
namespace {

constexpr double kParallel = 1e-14;  // sine of an angle below which lines count as parallel

Vec3 at(const MovingBall& ball, double distance_m) {
  return ball.from + distance_m * ball.direction;
}

/// A polygon in a plane: corners counter-clockwise about the normal.
struct Polygon {
  const Plane& plane;
  std::span<const Vec3> points;                 ///< All vertices.
  std::span<const std::uint32_t> corners = {};  ///< Indices into `points`; empty: all, in order.

  std::size_t size() const { return corners.empty() ? points.size() : corners.size(); }
  const Vec3& corner(std::size_t i) const {
    const std::size_t k = i % size();
    return corners.empty() ? points[k] : points[corners[k]];
  }
  /// True if a point of the plane is in the polygon.
  bool contains(const Vec3& point) const {
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3 edge = corner(i + 1) - corner(i);
      if (plane.normal.dot(edge.cross(point - corner(i))) < 0) return false;
    }
    return true;
  }
};

/// Keeps the nearer of two hits.
void keep_nearer(std::optional<SurfaceHit>& best, const std::optional<SurfaceHit>& hit) {
  if (hit && (!best || hit->distance_m < best->distance_m)) best = hit;
}

/// Returns where the ball's centre enters the cylinder of its radius about an edge, between the
/// edge's ends.
std::optional<SurfaceHit> cast_at_edge(const MovingBall& ball, const Vec3& a, const Vec3& b) {
  const double length_m = (b - a).norm();
  if (!(length_m > 0)) return std::nullopt;
  const Vec3 along = (b - a) / length_m;
  const Vec3 across = ball.direction - ball.direction.dot(along) * along;
  const Vec3 start = ball.from - a - (ball.from - a).dot(along) * along;
  const double aa = across.squaredNorm(), ab = across.dot(start);
  if (aa < kParallel * kParallel) return std::nullopt;  // meets an end first, if at all
  const double root2 = ab * ab - aa * (start.squaredNorm() - ball.radius_m * ball.radius_m);
  if (root2 < 0) return std::nullopt;
  const double distance_m = (-ab - std::sqrt(root2)) / aa;
  if (distance_m < 0 || distance_m > ball.reach_m) return std::nullopt;
  const double place = (at(ball, distance_m) - a).dot(along);
  if (place < 0 || place > length_m) return std::nullopt;
  return SurfaceHit{distance_m, (at(ball, distance_m) - a - place * along).normalized()};
}

/// Returns where the ball meets a polygon from its front: its face, its edges or its corners.
std::optional<SurfaceHit> cast_at_polygon(const MovingBall& ball, const Polygon& polygon) {
  std::optional<SurfaceHit> best;
  const double fall = polygon.plane.normal.dot(ball.direction);
  if (fall < 0) {
    const double distance_m = (ball.radius_m - polygon.plane.distance(ball.from)) / fall;
    if (distance_m >= 0 && distance_m <= ball.reach_m) {
      const Vec3 foot = at(ball, distance_m) - ball.radius_m * polygon.plane.normal;
      if (polygon.contains(foot)) best = {distance_m, polygon.plane.normal};
    }
  }
  if (ball.radius_m == 0) return best;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    keep_nearer(best, cast_at_edge(ball, polygon.corner(i), polygon.corner(i + 1)));
    keep_nearer(best, cast_at_ball(ball, polygon.corner(i), 0));
  }
  return best;
}

double distance_to_edge(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double square = along.squaredNorm();
  const double place = square > 0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0;
  return (point - a - place * along).norm();
}

/// Returns the distance from a point to a polygon.
double distance(const Polygon& polygon, const Vec3& point) {
  const double height_m = polygon.plane.distance(point);
  if (polygon.contains(point - height_m * polygon.plane.normal)) return std::abs(height_m);
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    least_m = std::min(least_m, distance_to_edge(polygon.corner(i), polygon.corner(i + 1), point));
  return least_m;
}

Polygon face_of(const ConvexPolyhedron& convex, std::size_t f) {
  return {convex.faces[f].plane, convex.vertices, convex.face_corners(f)};
}

SurfaceHit hit_at_start(const MovingBall& ball) { return {0, -ball.direction}; }

/// Returns where a ray enters a convex.
std::optional<SurfaceHit> cast_ray(const MovingBall& ray, const ConvexPolyhedron& convex) {
  double enter_m = 0, leave_m = ray.reach_m;
  const Plane* entered = nullptr;
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const double height_m = face.plane.distance(ray.from);
    const double rise = face.plane.normal.dot(ray.direction);
    if (rise >= 0 && height_m > 0) return std::nullopt;
    if (rise == 0) continue;
    const double distance_m = -height_m / rise;
    if (rise > 0) {
      leave_m = std::min(leave_m, distance_m);
    } else if (distance_m > enter_m || (height_m > 0 && !entered)) {
      enter_m = std::max(enter_m, distance_m);
      entered = &face.plane;
    }
    if (enter_m > leave_m) return std::nullopt;
  }
  if (!entered) return hit_at_start(ray);
  return SurfaceHit{enter_m, entered->normal};
}

}  // namespace

std::optional<SurfaceHit> cast_at_ball(const MovingBall& ball, const Vec3& center,
                                       double radius_m) {
  const double sum_m = ball.radius_m + radius_m;
  const Vec3 start = ball.from - center;
  const double along = start.dot(ball.direction);
  const double outside = start.squaredNorm() - sum_m * sum_m;
  if (outside <= 0) return hit_at_start(ball);
  const double root2 = along * along - outside;
  if (along > 0 || root2 < 0) return std::nullopt;
  const double distance_m = -along - std::sqrt(root2);
  if (distance_m > ball.reach_m) return std::nullopt;
  return SurfaceHit{distance_m, (at(ball, distance_m) - center).normalized()};
}

std::optional<SurfaceHit> cast(const MovingBall& ball, const Plane& plane) {
  const double height_m = plane.distance(ball.from) - ball.radius_m;
  if (height_m <= 0) return hit_at_start(ball);
  const double fall = -plane.normal.dot(ball.direction);
  if (fall <= 0 || height_m > fall * ball.reach_m) return std::nullopt;
  return SurfaceHit{height_m / fall, plane.normal};
}

std::optional<SurfaceHit> cast_at_front(const MovingBall& ball,
                                        const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(normal.norm() > 0) || normal.dot(ball.direction) >= 0) return std::nullopt;
  const Plane plane = Plane::through(corners[0], normal.normalized());
  const Polygon triangle{plane, corners};
  if (plane.distance(ball.from) < 0) return std::nullopt;
  if (ball.radius_m > 0 && distance(triangle, ball.from) <= ball.radius_m)
    return hit_at_start(ball);
  return cast_at_polygon(ball, triangle);
}

std::optional<SurfaceHit> cast(const MovingBall& ball, const ConvexPolyhedron& convex) {
  if (ball.radius_m == 0) return cast_ray(ball, convex);
  if (is_within(convex, ball.from, ball.radius_m)) return hit_at_start(ball);
  std::optional<SurfaceHit> best;
  for (std::size_t f = 0; f < convex.faces.size(); ++f)
    keep_nearer(best, cast_at_polygon(ball, face_of(convex, f)));
  return best;
}

double distance(const ConvexPolyhedron& convex, const Vec3& point) {
  double least_m = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    if (convex.faces[f].plane.distance(point) <= 0) continue;  // the nearest point is on another
    inside = false;
    least_m = std::min(least_m, distance(face_of(convex, f), point));
  }
  return inside ? 0 : least_m;
}

bool is_within(const ConvexPolyhedron& convex, const Vec3& point, double radius_m) {
  double height_m = 0;
  for (const ConvexPolyhedron::Face& face : convex.faces)
    height_m = std::max(height_m, face.plane.distance(point));
  if (height_m == 0 || height_m > radius_m) return height_m == 0;
  const auto near = [&](const Vec3& vertex) {
    return (vertex - point).squaredNorm() <= radius_m * radius_m;
  };
  return std::ranges::any_of(convex.vertices, near) || distance(convex, point) <= radius_m;
}

bool overlaps(const ConvexPolyhedron& convex, const Pose& X_QC, const Box& box_Q) {
  std::vector<Vec3> points;
  for (const Vec3& vertex : convex.vertices) points.push_back(X_QC * vertex);
  const Vec3 center = box_Q.center(), half = 0.5 * box_Q.extent();
  const auto separates = [&](const Vec3& axis) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec3& point : points) {
      least = std::min(least, axis.dot(point - center));
      most = std::max(most, axis.dot(point - center));
    }
    const double reach = axis.cwiseAbs().dot(half);
    return least > reach || most < -reach;
  };
  for (int k = 0; k < 3; ++k)
    if (separates(Vec3::Unit(k))) return false;
  for (const ConvexPolyhedron::Face& face : convex.faces)
    if (separates(X_QC.rotation * face.plane.normal)) return false;
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    const std::span<const std::uint32_t> corners = convex.face_corners(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % corners.size()];
      if (from > to) continue;  // each edge has two faces
      const Vec3 edge = points[to] - points[from];
      for (int k = 0; k < 3; ++k) {
        const Vec3 axis = edge.cross(Vec3::Unit(k));
        if (axis.squaredNorm() > kParallel * edge.squaredNorm() && separates(axis)) return false;
      }
    }
  }
  return true;
}

}  // namespace sunder
