// Splitting of edges in the planes of walls, a step of outer_surface().
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

/// Greatest number of rounds of splitting. One or two rounds usually suffice, since the parts of a
/// split edge deviate from it by at most the tolerance.
constexpr int kMaxSplitRounds = 12;

/// Points to insert into edges.
using Splits = std::map<PointPair, std::set<std::uint32_t>>;

/// The different edges and points of the faces in one plane.
struct PlaneEdges {
  std::vector<PointPair> edges;
  std::vector<std::uint32_t> points;
};

PlaneEdges edges_in(const PieceSurface& surface, const WallPlane& plane) {
  PlaneEdges result;
  for (const std::uint32_t f : plane.faces) {
    for (const PieceSurface::Contour& contour : surface.faces[f].contours) {
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const std::uint32_t next = contour[i + 1 < contour.size() ? i + 1 : 0].point;
        result.points.push_back(contour[i].point);
        result.edges.push_back(point_pair(contour[i].point, next));
      }
    }
  }
  const auto make_unique = [](auto& all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  make_unique(result.points);
  make_unique(result.edges);
  return result;
}

/// Finds the points at which to split edges, plane by plane, and then splits the edges.
class EdgeSplitter {
 public:
  EdgeSplitter(PieceSurface& surface, double tolerance_m)
      : surface_(surface), tolerance_m_(tolerance_m) {}

  void find_splits(const WallPlane& plane) {
    PlaneEdges in = edges_in(surface_, plane);
    choose_axis(in);
    find_points_on_edges(in);
    find_crossings(in, plane.normal);
  }

  /// Splits the edges. Returns false if there was nothing to split.
  bool apply() {
    if (splits_.empty()) return false;
    for (PieceSurface::Face& face : surface_.faces) {
      for (PieceSurface::Contour& contour : face.contours) apply(contour);
      std::erase_if(face.contours, [](const auto& contour) { return contour.empty(); });
    }
    splits_.clear();
    return true;
  }

 private:
  const Vec3& at(std::uint32_t point) const { return surface_.points[point]; }

  /// Sets the axis along which the points of the plane have the largest extent.
  void choose_axis(const PlaneEdges& in) {
    Box box;
    for (const std::uint32_t point : in.points) box.extend(at(point));
    if (!in.points.empty()) box.extent().maxCoeff(&axis_);
  }

  double low(const PointPair& edge) const {
    return std::min(at(edge[0])[axis_], at(edge[1])[axis_]);
  }
  double high(const PointPair& edge) const {
    return std::max(at(edge[0])[axis_], at(edge[1])[axis_]);
  }

  bool is_on(std::uint32_t point, const PointPair& edge) const {
    if (point == edge[0] || point == edge[1]) return false;
    const Vec3 along = at(edge[1]) - at(edge[0]), to = at(point) - at(edge[0]);
    const double t = along.dot(to) / along.squaredNorm();
    if (!(t > 0 && t < 1)) return false;
    return (to - t * along).norm() <= tolerance_m_;
  }

  void find_points_on_edges(PlaneEdges& in) {
    std::sort(in.points.begin(), in.points.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(at(a)[axis_], a) < std::pair(at(b)[axis_], b);
    });
    for (const PointPair& edge : in.edges) {
      const double from = low(edge) - tolerance_m_, to = high(edge) + tolerance_m_;
      auto it = std::lower_bound(
          in.points.begin(), in.points.end(), from,
          [&](std::uint32_t point, double value) { return at(point)[axis_] < value; });
      for (; it != in.points.end() && at(*it)[axis_] <= to; ++it) {
        if (is_on(*it, edge)) splits_[edge].insert(*it);
      }
    }
  }

  void find_crossings(PlaneEdges& in, const Vec3& normal) {
    std::sort(in.edges.begin(), in.edges.end(), [&](const PointPair& a, const PointPair& b) {
      return std::pair(low(a), a) < std::pair(low(b), b);
    });
    for (std::size_t i = 0; i < in.edges.size(); ++i) {
      const double end = high(in.edges[i]);
      for (std::size_t j = i + 1; j < in.edges.size() && low(in.edges[j]) <= end; ++j) {
        cross(in.edges[i], in.edges[j], normal);
      }
    }
  }

  /// Splits two edges where they cross in the interior of both.
  void cross(const PointPair& e, const PointPair& g, const Vec3& normal) {
    if (e[0] == g[0] || e[0] == g[1] || e[1] == g[0] || e[1] == g[1]) return;
    const Vec3 along_e = at(e[1]) - at(e[0]), along_g = at(g[1]) - at(g[0]);
    const Vec3 across_e = normal.cross(along_e).normalized();
    const Vec3 across_g = normal.cross(along_g).normalized();
    const double g0 = across_e.dot(at(g[0]) - at(e[0])), g1 = across_e.dot(at(g[1]) - at(e[0]));
    if (std::min(std::abs(g0), std::abs(g1)) <= tolerance_m_ || (g0 > 0) == (g1 > 0)) return;
    const double e0 = across_g.dot(at(e[0]) - at(g[0])), e1 = across_g.dot(at(e[1]) - at(g[0]));
    if (std::min(std::abs(e0), std::abs(e1)) <= tolerance_m_ || (e0 > 0) == (e1 > 0)) return;
    const Vec3 place = at(e[0]) + e0 / (e0 - e1) * along_e;
    const std::uint32_t point = crossing_at(place, e, g);
    splits_[e].insert(point);
    splits_[g].insert(point);
  }

  /// Returns the point within the tolerance that splits either edge, any other point there, or a
  /// new point.
  std::uint32_t crossing_at(const Vec3& place, const PointPair& e, const PointPair& g) {
    const auto is_here = [&](std::uint32_t known) {
      return (at(known) - place).norm() <= tolerance_m_;
    };
    for (const PointPair& edge : {e, g}) {
      const auto points = splits_.find(edge);
      if (points == splits_.end()) continue;
      const auto known = std::ranges::find_if(points->second, is_here);
      if (known != points->second.end()) return *known;
    }
    const auto count = static_cast<std::uint32_t>(surface_.points.size());
    for (std::uint32_t known = 0; known < count; ++known) {
      if (is_here(known)) return known;
    }
    surface_.points.push_back(place);
    return count;
  }

  void apply(PieceSurface::Contour& contour) {
    PieceSurface::Contour result;
    bool is_split = false;
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const PieceSurface::Corner &a = contour[i], &b = contour[i + 1 < contour.size() ? i + 1 : 0];
      result.push_back(a);
      const auto found = splits_.find(point_pair(a.point, b.point));
      if (found == splits_.end()) continue;
      is_split = true;
      add_between(a, b, found->second, result);
    }
    if (!is_split) return;
    contour = std::move(result);
    clean_contour(contour);
  }

  /// Appends corners for the points on an edge, in an order that is the same from both ends of it.
  void add_between(const PieceSurface::Corner& a, const PieceSurface::Corner& b,
                   const std::set<std::uint32_t>& points, PieceSurface::Contour& result) const {
    const PointPair edge = point_pair(a.point, b.point);
    const Vec3 along = at(edge[1]) - at(edge[0]);
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const std::uint32_t point : points) {
      order.emplace_back(along.dot(at(point) - at(edge[0])) / along.squaredNorm(), point);
    }
    std::sort(order.begin(), order.end());
    const bool forward = a.point == edge[0];
    if (!forward) std::reverse(order.begin(), order.end());
    for (const auto& [t, point] : order) {
      const auto share = static_cast<float>(forward ? t : 1 - t);
      const Vec3f normal = (1 - share) * a.normal + share * b.normal;
      const float length = normal.norm();
      result.push_back({point, length > 0 ? Vec3f(normal / length) : a.normal,
                        (1 - share) * a.uv + share * b.uv});
    }
  }

  PieceSurface& surface_;
  const double tolerance_m_;
  int axis_ = 0;
  Splits splits_;
};

}  // namespace

bool split_edges(PieceSurface& surface, std::span<const WallPlane> planes, double tolerance_m) {
  EdgeSplitter splitter(surface, tolerance_m);
  for (int round = 0; round < kMaxSplitRounds; ++round) {
    for (const WallPlane& plane : planes) splitter.find_splits(plane);
    if (!splitter.apply()) return true;
  }
  return false;
}

}  // namespace sunder
