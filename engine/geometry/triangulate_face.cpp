// Holes are joined to the contour around them by bridge edges (Eberly 2008), then ears are clipped.
#include "engine/geometry/triangulate_face.h"

#include <algorithm>
#include <limits>

namespace sunder {
namespace {

/// Bound of the number of point-in-ear tests, for each corner of a face. Later ears are not tested.
constexpr std::size_t kMaxTestsPerCorner = 4000;

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool in_triangle(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
}

class FaceTriangulator {
 public:
  using Loop = std::vector<std::uint32_t>;  ///< Indices of corners of the mesh.

  FaceTriangulator(const PolygonMesh& mesh, const PolygonMesh::Face& face)
      : mesh_(mesh), first_(mesh.contours[face.first_contour].first_corner) {
    int x = 0;
    const Vec3& normal = face.plane.normal;
    normal.cwiseAbs().maxCoeff(&x);
    const int u = (x + 1) % 3, v = (x + 2) % 3;
    const bool flip = normal[x] < 0;
    for (std::uint32_t k = 0; k < face.contour_count; ++k) {
      const PolygonMesh::Contour& contour = mesh.contours[face.first_contour + k];
      Loop loop;
      for (std::uint32_t i = 0; i < contour.corner_count; ++i) {
        const Vec3& at = mesh.vertices[mesh.corners[contour.first_corner + i]];
        points_.emplace_back(flip ? -at[u] : at[u], at[v]);
        loop.push_back(contour.first_corner + i);
      }
      (area(loop) >= 0 ? outer_ : holes_).push_back(std::move(loop));
    }
    tests_left_ = kMaxTestsPerCorner * points_.size();
  }

  std::vector<Triangle> run() {
    if (outer_.empty()) std::swap(outer_, holes_);
    join_holes();
    for (Loop& loop : outer_) cut_ears(loop);
    return std::move(triangles_);
  }

 private:
  const Vec2& at(std::uint32_t corner) const { return points_[corner - first_]; }

  double area(const Loop& loop) const {
    double twice = 0;
    for (std::size_t i = 2; i < loop.size(); ++i) {
      twice += cross(at(loop[0]), at(loop[i - 1]), at(loop[i]));
    }
    return twice;
  }

  /// Joins all holes, rightmost first: those to the right of a hole are then part of an outer loop.
  void join_holes() {
    for (Loop& hole : holes_) {
      const auto rightmost =
          std::max_element(hole.begin(), hole.end(),
                           [&](std::uint32_t a, std::uint32_t b) { return at(a).x() < at(b).x(); });
      std::rotate(hole.begin(), rightmost, hole.end());
    }
    std::stable_sort(holes_.begin(), holes_.end(),
                     [&](const Loop& a, const Loop& b) { return at(a[0]).x() > at(b[0]).x(); });
    for (const Loop& hole : holes_) bridge_hole(hole);
  }

  /// Joins a hole, whose first corner is its rightmost, to the nearest outer loop to its right.
  void bridge_hole(const Loop& hole) {
    const Vec2& from = at(hole[0]);
    double nearest = std::numeric_limits<double>::infinity();
    Loop* around = &outer_[0];
    std::size_t edge = 0;
    for (Loop& loop : outer_) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2 &a = at(loop[i]), &b = at(loop[(i + 1) % loop.size()]);
        if (!(a.y() <= from.y() && b.y() > from.y())) continue;  // no upward edge at this height
        const double x = a.x() + (from.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        if (x < from.x() || x >= nearest) continue;
        nearest = x;
        around = &loop;
        edge = i;
      }
    }
    const std::size_t to = find_visible_corner(*around, edge, from, nearest);
    Loop joined(around->begin(), around->begin() + static_cast<std::ptrdiff_t>(to + 1));
    joined.insert(joined.end(), hole.begin(), hole.end());
    joined.push_back(hole[0]);
    joined.insert(joined.end(), around->begin() + static_cast<std::ptrdiff_t>(to), around->end());
    *around = std::move(joined);
  }

  /// Returns a corner of `loop` visible from `from`, whose ray to the right meets `edge` at x.
  std::size_t find_visible_corner(const Loop& loop, std::size_t edge, const Vec2& from,
                                  double x) const {
    const std::size_t next = (edge + 1) % loop.size();
    std::size_t best = at(loop[edge]).x() > at(loop[next]).x() ? edge : next;
    const Vec2 opposite(x, from.y()), end = at(loop[best]);
    const bool above = end.y() > from.y();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2& p = at(loop[i]);
      if (p.x() < from.x() || p == end) continue;
      if (!(above ? in_triangle(p, from, opposite, end) : in_triangle(p, from, end, opposite)))
        continue;
      const double slope = std::abs(p.y() - from.y()) / std::max(p.x() - from.x(), 1e-300);
      if (slope >= least || !is_reflex(loop, i)) continue;
      least = slope;
      best = i;
    }
    return best;
  }

  bool is_reflex(const Loop& loop, std::size_t i) const {
    const std::size_t n = loop.size();
    return cross(at(loop[(i + n - 1) % n]), at(loop[i]), at(loop[(i + 1) % n])) < 0;
  }

  void cut_ears(Loop& loop) {
    std::size_t i = 0, rejected = 0;
    while (loop.size() > 3) {
      const std::size_t n = loop.size();
      if (rejected < n && !is_ear(loop, i % n)) {
        ++rejected;
        ++i;
        continue;
      }
      const std::size_t here = i % n;
      triangles_.push_back({loop[(here + n - 1) % n], loop[here], loop[(here + 1) % n]});
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(here));
      rejected = 0;
      i = here == 0 ? 0 : here;  // goes on with the next corner, which avoids fans
    }
    if (loop.size() == 3) triangles_.push_back({loop[0], loop[1], loop[2]});
  }

  bool is_ear(const Loop& loop, std::size_t i) {
    const std::size_t n = loop.size();
    const Vec2 &a = at(loop[(i + n - 1) % n]), &b = at(loop[i]), &c = at(loop[(i + 1) % n]);
    if (cross(a, b, c) <= 0) return false;
    if (tests_left_ < n) return true;
    tests_left_ -= n;
    return std::none_of(loop.begin(), loop.end(), [&](std::uint32_t corner) {
      const Vec2& p = at(corner);
      return p != a && p != b && p != c && in_triangle(p, a, b, c);
    });
  }

  const PolygonMesh& mesh_;
  std::uint32_t first_;
  std::vector<Vec2> points_;  ///< The face's corners, projected to its plane.
  std::vector<Loop> outer_, holes_;
  std::vector<Triangle> triangles_;
  std::size_t tests_left_ = 0;
};

}  // namespace

std::vector<Triangle> triangulate(const PolygonMesh& mesh, std::size_t f) {
  const PolygonMesh::Face& face = mesh.faces[f];
  const PolygonMesh::Contour& contour = mesh.contours[face.first_contour];
  if (face.contour_count == 1 && contour.corner_count == 3) {
    const std::uint32_t first = contour.first_corner;
    return {{first, first + 1, first + 2}};
  }
  return FaceTriangulator(mesh, face).run();
}

}  // namespace sunder
