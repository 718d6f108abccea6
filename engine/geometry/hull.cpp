// The hull by its dual: a point p is the half-space p·y <= 1, the hull of points is the dual of
// their half-spaces' intersection, and clip() intersects half-spaces closed whatever the rounding.
// Coplanar points, collinear points and duplicates are planes through existing vertices, which
// clip() handles exactly like any other case. The hull's corners are the given points themselves.
#include "engine/geometry/hull.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "engine/geometry/clip.h"
#include "engine/geometry/farthest.h"

namespace sunder {
namespace {

/// In the affine space where the starting tetrahedron is regular: there, flat and tiny solids are
/// as easy as cubes. Noise just as large may fold a face over; then the next is tried.
constexpr double kDualTolerances[] = {1e-10, 1e-9, 1e-11, 1e-8, 1e-12};
/// The least height of the starting tetrahedron over its length.
constexpr double kFlat = 1e-9;
/// Area, over its length and the solid's, of a face too small or thin to tell its plane.
constexpr double kSliver = 1e-6;

using Tetrahedron = std::array<std::uint32_t, 4>;

/// A regular tetrahedron whose dual is its own mirror image through the origin.
Eigen::Matrix<double, 3, 4> regular_tetrahedron() {
  Eigen::Matrix<double, 3, 4> r;
  r << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  return r;
}

/// Four points that span about as much as any four, as left-handed as regular_tetrahedron(); none
/// if the points lie in a plane.
std::optional<Tetrahedron> spanning_tetrahedron(std::span<const Vec3> points) {
  if (points.size() < 4) return std::nullopt;
  const std::uint32_t i = farthest(points, [&](const Vec3& p) { return (p - points[0]).norm(); });
  const Vec3 a = points[i];
  const std::uint32_t j = farthest(points, [&](const Vec3& p) { return (p - a).norm(); });
  const Vec3 ab = points[j] - a;
  const std::uint32_t k = farthest(points, [&](const Vec3& p) { return ab.cross(p - a).norm(); });
  const Vec3 normal = ab.cross(points[k] - a);
  if (!(normal.norm() > kFlat * ab.squaredNorm())) return std::nullopt;
  const Vec3 up = normal.normalized();
  const std::uint32_t l = farthest(points, [&](const Vec3& p) { return std::abs(up.dot(p - a)); });
  const double height = up.dot(points[l] - a);
  if (!(std::abs(height) > kFlat * ab.norm())) return std::nullopt;
  return height > 0 ? Tetrahedron{i, k, j, l} : Tetrahedron{i, j, k, l};
}

/// The linear part of the affine map that makes the tetrahedron regular.
Mat3 regularising_map(std::span<const Vec3> points, const Tetrahedron& start) {
  const Eigen::Matrix<double, 3, 4> r = regular_tetrahedron();
  Mat3 edges, regular_edges;
  for (int c = 0; c < 3; ++c) {
    edges.col(c) = points[start[static_cast<std::size_t>(c + 1)]] - points[start[0]];
    regular_edges.col(c) = r.col(c + 1) - r.col(0);
  }
  const double size = edges.cwiseAbs().maxCoeff();  // keeps the determinant in range
  return regular_edges * (edges / size).inverse() / size;
}

/// The dual of the starting tetrahedron. A face's id is the index of its point.
ConvexPolyhedron starting_dual(const Tetrahedron& start) {
  const Eigen::Matrix<double, 3, 4> r = regular_tetrahedron();
  ConvexPolyhedron dual;
  for (int v = 0; v < 4; ++v) dual.vertices.push_back(-r.col(v));
  constexpr std::uint32_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (std::size_t f = 0; f < 4; ++f) {
    add_face(dual, kFaces[f]);
    dual.faces.back().id.value = start[f];
  }
  return dual;
}

ConvexPolyhedron dual_of_hull(std::span<const Vec3> points, const Tetrahedron& start,
                              const Mat3& map, double tolerance) {
  std::vector<Vec3> moved;
  moved.reserve(points.size());
  for (const Vec3& p : points) {
    moved.push_back(regular_tetrahedron().col(0) + map * (p - points[start[0]]));
  }
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  // Far points first: they leave little for the others to do.
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = moved[a].squaredNorm(), at_b = moved[b].squaredNorm();
    return at_a != at_b ? at_a > at_b : a < b;
  });
  ConvexPolyhedron dual = starting_dual(start), next;
  ClipScratch scratch;
  for (const std::uint32_t i : order) {
    const double distance = moved[i].norm();
    if (distance * distance < 1.0 / 3) break;  // inside the starting tetrahedron, and so the rest
    const Plane plane{moved[i] / distance, -1 / distance};
    if (clip(dual, plane, {i}, tolerance, next, scratch) == PlaneSide::kCut) {
      std::swap(dual, next);
    }
  }
  return dual;
}

/// A corner of the dual: `face` at `vertex`, between the edges to `next` and from `previous`.
struct Fan {
  std::uint32_t vertex, next, previous, face;
};

std::vector<Fan> fans(const ConvexPolyhedron& dual) {
  std::vector<Fan> result;
  for (std::uint32_t f = 0; f < dual.faces.size(); ++f) {
    const auto corners = dual.face_corners(f);
    for (std::size_t i = 0, n = corners.size(); i < n; ++i) {
      result.push_back({corners[i], corners[(i + 1) % n], corners[(i + n - 1) % n], f});
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Fan& a, const Fan& b) { return a.vertex < b.vertex; });
  return result;
}

/// Gives a sliver, whose corners hardly tell a plane, the normal that the dual has for it. False if
/// the face is folded over.
bool settle_last_face(ConvexPolyhedron& hull, const Vec3& dual_normal, double size) {
  ConvexPolyhedron::Face& face = hull.faces.back();
  const auto corners = hull.face_corners(hull.faces.size() - 1);
  const Vec3& first = hull.vertices[corners[0]];
  double longest = 0;
  for (const std::uint32_t v : corners) {
    longest = std::max(longest, (hull.vertices[v] - first).norm());
  }
  if (face_area(hull, hull.faces.size() - 1) > kSliver * longest * size) {
    return face.plane.normal.dot(dual_normal) > 0;
  }
  face.plane = Plane::through(first, dual_normal);
  std::fill(hull.corner_normals.begin() + face.first_corner, hull.corner_normals.end(),
            Vec3f(dual_normal.cast<float>()));
  return true;
}

/// Fills the hull; false if a face is folded over.
bool make_faces(std::span<const Vec3> points, const ConvexPolyhedron& dual, const Mat3& map,
                double size, ConvexPolyhedron& hull) {
  hull = {};
  for (const ConvexPolyhedron::Face& face : dual.faces) {
    hull.vertices.push_back(points[face.id.value]);
  }
  bool sound = true;
  const std::vector<Fan> all = fans(dual);
  std::vector<std::uint32_t> corners;
  for (auto begin = all.begin(); begin != all.end();) {  // a vertex of the dual: a face of the hull
    const auto end =
        std::find_if(begin, all.end(), [&](const Fan& fan) { return fan.vertex != begin->vertex; });
    corners.clear();
    auto fan = begin;
    do {
      corners.push_back(fan->face);
      fan = std::find_if(begin, end, [&](const Fan& other) { return other.next == fan->previous; });
    } while (fan != begin);
    // A vertex within tolerance of the edge between two others makes an empty face of two corners.
    if (corners.size() >= 3) {
      add_face(hull, corners);
      const Vec3 normal = (map.transpose() * dual.vertices[begin->vertex]).normalized();
      sound = settle_last_face(hull, normal, size) && sound;
    }
    begin = end;
  }
  return sound;
}

}  // namespace

ConvexPolyhedron make_hull(std::span<const Vec3> points) {
  ConvexPolyhedron hull;
  const std::optional<Tetrahedron> start = spanning_tetrahedron(points);
  if (!start) return hull;
  const Mat3 map = regularising_map(points, *start);
  Box box;
  for (const Vec3& p : points) box.extend(p);
  const double size = box.extent().norm();
  for (const double tolerance : kDualTolerances) {
    const ConvexPolyhedron dual = dual_of_hull(points, *start, map, tolerance);
    if (make_faces(points, dual, map, size, hull)) break;
  }
  return hull;
}

}  // namespace sunder
