// The hull is computed by duality: the dual of a point p is the half-space p·y <= 1, and the hull
// of points is the dual of the intersection of their half-spaces, which clip() computes with closed
// topology whatever the rounding. Coplanar, collinear and duplicate points become planes through
// existing vertices, which clip() handles as any others. The hull's vertices are the given points.
#include "engine/geometry/hull.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "engine/geometry/clip.h"
#include "engine/geometry/farthest.h"

namespace sunder {
namespace {

/// Tolerances of clip() in the affine space where the starting tetrahedron is regular, so that they
/// suit flat and tiny solids too. If rounding errors of that size invert a face, the next is tried.
constexpr double kDualTolerances[] = {1e-10, 1e-9, 1e-11, 1e-8, 1e-12};
/// Least height of the starting tetrahedron, and of its base triangle, over its longest edge.
constexpr double kMinHeightRatio = 1e-9;
/// Least area of a face, over its length times the solid's, from which its normal is computed.
constexpr double kMinFaceAreaRatio = 1e-6;

using Tetrahedron = std::array<std::uint32_t, 4>;

/// Returns a regular tetrahedron whose dual is its mirror image through the origin.
Eigen::Matrix<double, 3, 4> regular_tetrahedron() {
  Eigen::Matrix<double, 3, 4> r;
  r << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  return r;
}

/// Returns four points that span a large tetrahedron, left-handed; none if all lie in a plane.
std::optional<Tetrahedron> spanning_tetrahedron(std::span<const Vec3> points) {
  if (points.size() < 4) return std::nullopt;
  const std::uint32_t i = farthest(points, [&](const Vec3& p) { return (p - points[0]).norm(); });
  const Vec3 a = points[i];
  const std::uint32_t j = farthest(points, [&](const Vec3& p) { return (p - a).norm(); });
  const Vec3 ab = points[j] - a;
  const std::uint32_t k = farthest(points, [&](const Vec3& p) { return ab.cross(p - a).norm(); });
  const Vec3 normal = ab.cross(points[k] - a);
  if (!(normal.norm() > kMinHeightRatio * ab.squaredNorm())) return std::nullopt;
  const Vec3 up = normal.normalized();
  const std::uint32_t l = farthest(points, [&](const Vec3& p) { return std::abs(up.dot(p - a)); });
  const double height = up.dot(points[l] - a);
  if (!(std::abs(height) > kMinHeightRatio * ab.norm())) return std::nullopt;
  return height > 0 ? Tetrahedron{i, k, j, l} : Tetrahedron{i, j, k, l};
}

/// Returns the linear part of the affine map that makes the tetrahedron regular.
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

/// Returns the dual of the starting tetrahedron. A face's id is the index of its point.
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
  // Far points come first: most of the others then do not cut the dual.
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = moved[a].squaredNorm(), at_b = moved[b].squaredNorm();
    return at_a != at_b ? at_a > at_b : a < b;
  });
  ConvexPolyhedron dual = starting_dual(start), next;
  ClipScratch scratch;
  for (const std::uint32_t i : order) {
    const double distance = moved[i].norm();
    // This and all further points are inside the starting tetrahedron.
    if (distance * distance < 1.0 / 3) break;
    const Plane plane{moved[i] / distance, -1 / distance};
    if (clip(dual, plane, {i}, tolerance, next, scratch) == PlaneSide::kCut) {
      std::swap(dual, next);
    }
  }
  return dual;
}

/// The corner of `face` of the dual at `vertex`, between the edges to `next` and from `previous`.
struct DualCorner {
  std::uint32_t vertex, next, previous, face;
};

std::vector<DualCorner> dual_corners(const ConvexPolyhedron& dual) {
  std::vector<DualCorner> result;
  for (std::uint32_t f = 0; f < dual.faces.size(); ++f) {
    const auto corners = dual.face_corners(f);
    for (std::size_t i = 0, n = corners.size(); i < n; ++i) {
      result.push_back({corners[i], corners[(i + 1) % n], corners[(i + n - 1) % n], f});
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const DualCorner& a, const DualCorner& b) { return a.vertex < b.vertex; });
  return result;
}

/// Gives the last face `dual_normal` if it is too thin. Returns false if the face is inverted.
bool set_last_face_normal(ConvexPolyhedron& hull, const Vec3& dual_normal, double size) {
  ConvexPolyhedron::Face& face = hull.faces.back();
  const auto corners = hull.face_corners(hull.faces.size() - 1);
  const Vec3& first = hull.vertices[corners[0]];
  double longest = 0;
  for (const std::uint32_t v : corners) {
    longest = std::max(longest, (hull.vertices[v] - first).norm());
  }
  if (face_area(hull, hull.faces.size() - 1) > kMinFaceAreaRatio * longest * size) {
    return face.plane.normal.dot(dual_normal) > 0;
  }
  face.plane = Plane::through(first, dual_normal);
  std::fill(hull.corner_normals.begin() + face.first_corner, hull.corner_normals.end(),
            Vec3f(dual_normal.cast<float>()));
  return true;
}

/// Makes the hull from its dual. Returns false if a face is inverted.
bool make_faces(std::span<const Vec3> points, const ConvexPolyhedron& dual, const Mat3& map,
                double size, ConvexPolyhedron& hull) {
  hull = {};
  for (const ConvexPolyhedron::Face& face : dual.faces) {
    hull.vertices.push_back(points[face.id.value]);
  }
  bool is_valid = true;
  const std::vector<DualCorner> all = dual_corners(dual);
  std::vector<std::uint32_t> corners;
  for (auto begin = all.begin(); begin != all.end();) {  // a vertex of the dual, a face of the hull
    const auto end = std::find_if(
        begin, all.end(), [&](const DualCorner& corner) { return corner.vertex != begin->vertex; });
    corners.clear();
    auto corner = begin;
    do {
      corners.push_back(corner->face);
      corner = std::find_if(
          begin, end, [&](const DualCorner& other) { return other.next == corner->previous; });
    } while (corner != begin);
    // A vertex within tolerance of the edge between two others gives a face of two corners: none.
    if (corners.size() >= 3) {
      add_face(hull, corners);
      const Vec3 normal = (map.transpose() * dual.vertices[begin->vertex]).normalized();
      is_valid = set_last_face_normal(hull, normal, size) && is_valid;
    }
    begin = end;
  }
  return is_valid;
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
