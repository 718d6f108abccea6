#include "engine/geometry/prism.h"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

/// Tolerance of a normal's z component.
constexpr double kNormalTolerance = 1e-6;
/// Tolerance of an outline over its diagonal.
constexpr double kOutlineTolerance = 1e-6;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::vector<Vec2> convex_outline(std::vector<Vec2> points, double tolerance_m) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& point, std::size_t least) {
    while (hull.size() > least) {
      const Vec2 last = hull.back() - hull[hull.size() - 2], next = point - hull.back();
      const double reach = (point - hull[hull.size() - 2]).norm();
      if (cross(last, next) > tolerance_m * reach) break;
      hull.pop_back();
    }
    if (hull.empty() || (point - hull.back()).norm() > tolerance_m) hull.push_back(point);
  };
  for (const Vec2& point : points) add(point, 1);
  const std::size_t lower = hull.size();
  for (auto it = points.rbegin(); it != points.rend(); ++it) add(*it, lower);
  if (hull.size() > 1 && (hull.front() - hull.back()).norm() <= tolerance_m) hull.pop_back();
  return hull;
}

std::optional<ZPrism> prism_along_z(const ConvexPolyhedron& convex, const Pose& X_WR) {
  const Mat3 rotation = X_WR.rotation.toRotationMatrix();
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const double z = std::abs(rotation.row(2).dot(face.plane.normal));
    if (z > kNormalTolerance && z < 1 - kNormalTolerance) return std::nullopt;
  }
  ZPrism prism;
  std::vector<Vec2> points;
  Box box;
  for (const Vec3& vertex : convex.vertices) {
    const Vec3 at = X_WR * vertex;
    box.extend(at);
    points.emplace_back(at.x(), at.y());
  }
  if (points.empty()) return std::nullopt;
  prism.low = box.min.z(), prism.high = box.max.z();
  const double tolerance_m = kOutlineTolerance * box.extent().head<2>().norm();
  prism.outline = convex_outline(std::move(points), tolerance_m);
  if (prism.outline.size() < 3) return std::nullopt;
  return prism;
}

}  // namespace sunder
