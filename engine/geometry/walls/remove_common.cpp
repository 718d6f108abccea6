// In a plane, each edge has on either side the faces that cover that side. Of m faces with an even
// name and n with an odd name that cover one place, |m - n| remain. Where a face remains on one
// side of an edge and not on the other, the edge bounds what is left of that face.
#include <algorithm>
#include <cmath>

#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The number of times that a face's contours pass an edge from its first point to its second, less
/// the number of times that they pass it the other way.
struct Passes {
  std::uint32_t face = 0;  ///< Index of WallPlane::faces.
  int count = 0;
};

struct DirectedEdge {
  std::uint32_t from = 0, to = 0;
};

/// Traces edges that have the inside to their left to contours, which touch each other in points at
/// most.
class ContourTracer {
 public:
  ContourTracer(std::vector<DirectedEdge> edges, const std::map<std::uint32_t, Vec2>& flat,
                bool mirrored)
      : edges_(std::move(edges)), flat_(flat), mirrored_(mirrored), used_(edges_.size(), 0) {
    std::sort(edges_.begin(), edges_.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
      return std::pair(a.from, a.to) < std::pair(b.from, b.to);
    });
  }

  /// Contours of points, the largest first; empty if one of them does not close.
  std::vector<std::vector<std::uint32_t>> run() {
    std::vector<std::pair<double, std::vector<std::uint32_t>>> found;
    for (std::size_t start = 0; start < edges_.size(); ++start) {
      if (used_[start]) continue;
      std::vector<std::uint32_t> contour;
      for (std::size_t e = start; !used_[e];) {
        used_[e] = 1;
        contour.push_back(edges_[e].from);
        if (edges_[e].to == edges_[start].from && !has_other_way(e, start)) break;
        const std::size_t next = next_of(e);
        if (next == edges_.size()) return {};
        e = next;
      }
      found.emplace_back(area(contour), std::move(contour));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::vector<std::uint32_t>> contours;
    for (auto& [size, contour] : found) contours.push_back(std::move(contour));
    return contours;
  }

 private:
  Vec2 at(std::uint32_t point) const {
    const Vec2& p = flat_.at(point);
    return mirrored_ ? Vec2(-p.x(), p.y()) : p;
  }

  /// True if a contour that comes back to its start goes on from there by another edge first.
  bool has_other_way(std::size_t e, std::size_t start) {
    used_[start] = 0;
    const std::size_t next = next_of(e);
    used_[start] = 1;
    return next != start;
  }

  /// The unused edge that is met first clockwise from the way back; the number of edges if none.
  std::size_t next_of(std::size_t e) const {
    const Vec2 back = at(edges_[e].from) - at(edges_[e].to);
    auto it = std::lower_bound(
        edges_.begin(), edges_.end(), edges_[e].to,
        [](const DirectedEdge& edge, std::uint32_t from) { return edge.from < from; });
    std::size_t best = edges_.size();
    double least = 0;
    for (; it != edges_.end() && it->from == edges_[e].to; ++it) {
      const auto i = static_cast<std::size_t>(it - edges_.begin());
      if (used_[i]) continue;
      const Vec2 out = at(it->to) - at(it->from);
      double angle = std::atan2(-cross(back, out), back.dot(out));  // clockwise
      if (angle <= 0) angle += 2 * EIGEN_PI;
      if (best != edges_.size() && angle >= least) continue;
      best = i;
      least = angle;
    }
    return best;
  }

  double area(const std::vector<std::uint32_t>& contour) const {
    double twice = 0;
    for (std::size_t i = 2; i < contour.size(); ++i) {
      twice += cross(at(contour[i - 1]) - at(contour[0]), at(contour[i]) - at(contour[0]));
    }
    return twice;
  }

  std::vector<DirectedEdge> edges_;
  const std::map<std::uint32_t, Vec2>& flat_;
  const bool mirrored_;
  std::vector<std::uint8_t> used_;
};

class CommonRemover {
 public:
  CommonRemover(PieceSurface& surface, const WallPlane& plane)
      : surface_(surface), plane_(plane), left_(plane.faces.size()), boxes_(plane.faces.size()) {
    const Vec3 x = plane.normal.unitOrthogonal(), y = plane.normal.cross(x);
    for (std::uint32_t i = 0; i < plane.faces.size(); ++i) {
      for (const PieceSurface::Contour& contour : face(i).contours) {
        for (std::size_t c = 0; c < contour.size(); ++c) {
          const std::uint32_t point = contour[c].point;
          const std::uint32_t next = contour[c + 1 < contour.size() ? c + 1 : 0].point;
          const Vec2 flat(x.dot(surface.points[point]), y.dot(surface.points[point]));
          flat_[point] = flat;
          boxes_[i].extend(flat);
          count(point, next, i);
        }
      }
    }
  }

  bool run() {
    for (const auto& [edge, passes] : edges_) divide(edge, passes);
    for (std::uint32_t i = 0; i < plane_.faces.size(); ++i) {
      if (!replace(i)) return false;
    }
    return true;
  }

 private:
  PieceSurface::Face& face(std::uint32_t i) const { return surface_.faces[plane_.faces[i]]; }
  bool is_odd(std::uint32_t i) const { return (face(i).id.value & 1) != 0; }

  void count(std::uint32_t from, std::uint32_t to, std::uint32_t i) {
    const PointPair edge = point_pair(from, to);
    std::vector<Passes>& passes = edges_[edge];
    if (passes.empty() || passes.back().face != i) passes.push_back({i, 0});
    passes.back().count += from == edge[0] ? 1 : -1;
  }

  /// Returns true if a face covers a point. The point must be on none of the face's edges.
  bool covers(std::uint32_t i, const Vec2& point) const {
    bool inside = false;
    for (const PieceSurface::Contour& contour : face(i).contours) {
      for (std::size_t c = 0; c < contour.size(); ++c) {
        const Vec2& a = flat_.at(contour[c].point);
        const Vec2& b = flat_.at(contour[c + 1 < contour.size() ? c + 1 : 0].point);
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        if (x > point.x()) inside = !inside;
      }
    }
    return inside;
  }

  /// The faces that cover either side of an edge, left and right of the way to its second point as
  /// seen from where the even faces are.
  std::array<std::vector<std::uint32_t>, 2> covering(const PointPair& edge,
                                                     const std::vector<Passes>& passes) const {
    std::array<std::vector<std::uint32_t>, 2> sides;
    const Vec2 middle = 0.5 * (flat_.at(edge[0]) + flat_.at(edge[1]));
    auto pass = passes.begin();
    for (std::uint32_t i = 0; i < plane_.faces.size(); ++i) {
      if (pass != passes.end() && pass->face == i) {
        const int count = is_odd(i) ? -pass->count : pass->count;
        ++pass;
        if (count != 0) {
          sides[count > 0 ? 0 : 1].push_back(i);
          continue;
        }
      } else if (!boxes_[i].contains(middle)) {
        continue;
      }
      if (!covers(i, middle)) continue;
      sides[0].push_back(i);
      sides[1].push_back(i);
    }
    return sides;
  }

  /// Returns the faces that are left of those that cover a place.
  std::vector<std::uint32_t> remaining(const std::vector<std::uint32_t>& covering) const {
    std::array<std::vector<std::uint32_t>, 2> by_name;
    for (const std::uint32_t i : covering) by_name[is_odd(i) ? 1 : 0].push_back(i);
    const bool more_odd = by_name[1].size() > by_name[0].size();
    std::vector<std::uint32_t> left = by_name[more_odd ? 1 : 0];
    left.resize(left.size() - by_name[more_odd ? 0 : 1].size());
    return left;
  }

  void divide(const PointPair& edge, const std::vector<Passes>& passes) {
    const auto sides = covering(edge, passes);
    const std::vector<std::uint32_t> on_left = remaining(sides[0]), on_right = remaining(sides[1]);
    const auto add = [&](const std::vector<std::uint32_t>& here,
                         const std::vector<std::uint32_t>& there, bool forward) {
      for (const std::uint32_t i : here) {
        if (std::find(there.begin(), there.end(), i) != there.end()) continue;
        const bool along = forward != is_odd(i);
        left_[i].push_back(along ? DirectedEdge{edge[0], edge[1]} : DirectedEdge{edge[1], edge[0]});
      }
    };
    add(on_left, on_right, true);
    add(on_right, on_left, false);
  }

  bool is_whole(std::uint32_t i) const {
    std::vector<PointPair> old_edges, new_edges;
    for (const PieceSurface::Contour& contour : face(i).contours) {
      for (std::size_t c = 0; c < contour.size(); ++c) {
        old_edges.push_back({contour[c].point, contour[c + 1 < contour.size() ? c + 1 : 0].point});
      }
    }
    for (const DirectedEdge& edge : left_[i]) new_edges.push_back({edge.from, edge.to});
    std::sort(old_edges.begin(), old_edges.end());
    std::sort(new_edges.begin(), new_edges.end());
    return old_edges == new_edges;
  }

  bool replace(std::uint32_t i) {
    if (is_whole(i)) return true;
    PieceSurface::Face& of = face(i);
    std::vector<PieceSurface::Contour> contours;
    if (!left_[i].empty()) {
      const auto traced = ContourTracer(left_[i], flat_, is_odd(i)).run();
      if (traced.empty()) return false;
      for (const std::vector<std::uint32_t>& points : traced) {
        contours.emplace_back();
        for (const std::uint32_t point : points) contours.back().push_back(corner(of, point));
        clean_contour(contours.back());
        if (contours.back().empty()) contours.pop_back();
      }
    }
    of.contours = std::move(contours);
    return true;
  }

  /// Returns a face's normal and texture coordinates at a point: those of its corner there, or else
  /// the linear interpolation from three corners far apart.
  PieceSurface::Corner corner(const PieceSurface::Face& of, std::uint32_t point) const {
    const Vec3& at = surface_.points[point];
    if (of.kind == FaceKind::kInterior && !surface_.has_uvs) {
      return {point, of.plane.normal.cast<float>(), planar_uv(at, of.plane.normal)};
    }
    const PieceSurface::Corner *a = nullptr, *b = nullptr, *c = nullptr;
    for (const PieceSurface::Contour& contour : of.contours) {
      for (const PieceSurface::Corner& known : contour) {
        if (known.point == point) return known;
        if (a == nullptr) a = &known;
      }
    }
    const Vec2& origin = flat_.at(a->point);
    double farthest = 0, largest = 0;
    for (const PieceSurface::Contour& contour : of.contours) {
      for (const PieceSurface::Corner& known : contour) {
        const double distance = (flat_.at(known.point) - origin).norm();
        if (distance > farthest) {
          farthest = distance;
          b = &known;
        }
      }
    }
    for (const PieceSurface::Contour& contour : of.contours) {
      for (const PieceSurface::Corner& known : contour) {
        const double area =
            std::abs(cross(flat_.at(b->point) - origin, flat_.at(known.point) - origin));
        if (area > largest) {
          largest = area;
          c = &known;
        }
      }
    }
    if (c == nullptr) return {point, a->normal, a->uv};
    const Vec2 ab = flat_.at(b->point) - origin, ac = flat_.at(c->point) - origin;
    const Vec2 to = flat_.at(point) - origin;
    const auto s = static_cast<float>(cross(to, ac) / cross(ab, ac));
    const auto t = static_cast<float>(cross(ab, to) / cross(ab, ac));
    const Vec3f normal = (1 - s - t) * a->normal + s * b->normal + t * c->normal;
    const float length = normal.norm();
    return {point, length > 0 ? Vec3f(normal / length) : a->normal,
            (1 - s - t) * a->uv + s * b->uv + t * c->uv};
  }

  PieceSurface& surface_;
  const WallPlane& plane_;
  std::map<std::uint32_t, Vec2> flat_;  ///< Points in the plane.
  std::map<PointPair, std::vector<Passes>> edges_;
  std::vector<std::vector<DirectedEdge>> left_;  ///< Outline of what is left, by face.
  std::vector<Eigen::AlignedBox2d> boxes_;       ///< By face.
};

}  // namespace

bool remove_common(PieceSurface& surface, const WallPlane& plane) {
  return CommonRemover(surface, plane).run();
}

}  // namespace sunder
