// Removal of the common parts of faces in one plane. For each side of an edge, the faces that cover
// that side are known. Of m faces with an even id and n with an odd id that cover a point, |m - n|
// remain there. An edge where a face remains on one side only is part of the outline of that face.
// Each face counts as often as it winds about the point, if outlines may cross themselves.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "engine/base/trigonometry.h"
#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The number of times that a face's contours contain an edge from its first point to its second,
/// less the number of times that they contain it in the other direction.
struct EdgeUse {
  std::uint32_t face = 0;  ///< Index of WallPlane::faces.
  int count = 0;
};

struct DirectedEdge {
  std::uint32_t from = 0, to = 0;
};

/// Connects directed edges, with the inside on their left, to contours that do not cross.
class ContourTracer {
 public:
  ContourTracer(std::vector<DirectedEdge> edges, const std::map<std::uint32_t, Vec2>& points_2d,
                bool is_mirrored)
      : edges_(std::move(edges)),
        points_2d_(points_2d),
        is_mirrored_(is_mirrored),
        used_(edges_.size(), 0) {
    std::sort(edges_.begin(), edges_.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
      return std::pair(a.from, a.to) < std::pair(b.from, b.to);
    });
  }

  /// Returns contours as sequences of points, by descending area; none if one is not closed.
  std::vector<std::vector<std::uint32_t>> run() {
    std::vector<std::pair<double, std::vector<std::uint32_t>>> found;
    for (std::size_t start = 0; start < edges_.size(); ++start) {
      if (used_[start]) continue;
      std::vector<std::uint32_t> contour;
      for (std::size_t e = start; !used_[e];) {
        used_[e] = 1;
        contour.push_back(edges_[e].from);
        if (edges_[e].to == edges_[start].from && !continues_elsewhere(e, start)) break;
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
    const Vec2& p = points_2d_.at(point);
    return is_mirrored_ ? Vec2(-p.x(), p.y()) : p;
  }

  /// Returns true if a contour that has returned to its start by edge `e` continues with another
  /// edge than `start`.
  bool continues_elsewhere(std::size_t e, std::size_t start) {
    used_[start] = 0;
    const std::size_t next = next_of(e);
    used_[start] = 1;
    return next != start;
  }

  /// Returns the unused edge first clockwise from the reverse of `e`; the number of edges if none.
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
      double angle = arc_tangent(-cross(back, out), back.dot(out));  // clockwise
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
  const std::map<std::uint32_t, Vec2>& points_2d_;
  const bool is_mirrored_;
  std::vector<std::uint8_t> used_;
};

/// Finds the remaining parts of the faces in one plane.
class CommonRemover {
 public:
  CommonRemover(PieceSurface& surface, const WallPlane& plane, bool cover_repeatedly)
      : surface_(surface),
        plane_(plane),
        cover_repeatedly_(cover_repeatedly),
        boxes_(plane.faces.size()) {
    const Vec3 x = plane.normal.unitOrthogonal(), y = plane.normal.cross(x);
    for (std::uint32_t i = 0; i < plane.faces.size(); ++i) {
      for (const PieceSurface::Contour& contour : face(i).contours) {
        for (std::size_t c = 0; c < contour.size(); ++c) {
          const std::uint32_t point = contour[c].point;
          const std::uint32_t next = contour[c + 1 < contour.size() ? c + 1 : 0].point;
          const Vec2 point_2d(x.dot(surface.points[point]), y.dot(surface.points[point]));
          points_2d_[point] = point_2d;
          boxes_[i].extend(point_2d);
          count(point, next, i);
        }
      }
    }
  }

  bool run() {
    if (!trace_outlines()) return false;
    for (std::uint32_t i = 0; i < plane_.faces.size(); ++i) replace(i);
    return true;
  }

 private:
  PieceSurface::Face& face(std::uint32_t i) const { return surface_.faces[plane_.faces[i]]; }
  bool is_odd(std::uint32_t i) const { return (face(i).id.value & 1) != 0; }

  void count(std::uint32_t from, std::uint32_t to, std::uint32_t i) {
    const PointPair edge = point_pair(from, to);
    std::vector<EdgeUse>& uses = edges_[edge];
    if (uses.empty() || uses.back().face != i) uses.push_back({i, 0});
    uses.back().count += from == edge[0] ? 1 : -1;
  }

  /// Finds the contours of what remains of each face. Returns false if one is not closed.
  bool trace_outlines() {
    outlines_.assign(plane_.faces.size(), {});
    contours_.assign(plane_.faces.size(), {});
    for (const auto& [edge, uses] : edges_) add_outline_edges(edge, uses);
    for (std::uint32_t i = 0; i < plane_.faces.size(); ++i) {
      if (outlines_[i].empty() || is_unchanged(i)) continue;
      contours_[i] = ContourTracer(outlines_[i], points_2d_, is_odd(i)).run();
      if (contours_[i].empty()) return false;
    }
    return true;
  }

  /// Returns how often a face winds about a point beside the middle of an edge, seen from its
  /// front: above the middle if the edge is horizontal, otherwise to its right.
  int winding_beside(std::uint32_t i, const PointPair& edge, const Vec2& middle) const {
    int turns = 0;
    for (const PieceSurface::Contour& contour : face(i).contours) {
      for (std::size_t c = 0; c < contour.size(); ++c) {
        const std::uint32_t from = contour[c].point;
        const std::uint32_t to = contour[c + 1 < contour.size() ? c + 1 : 0].point;
        const Vec2 &a = points_2d_.at(from), &b = points_2d_.at(to);
        if ((a.y() > middle.y()) == (b.y() > middle.y()) || point_pair(from, to) == edge) continue;
        const double x = a.x() + (middle.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        if (x > middle.x()) turns += b.y() > a.y() ? 1 : -1;
      }
    }
    return is_odd(i) ? -turns : turns;
  }

  /// A face and how often it covers a place; negative if it covers that with its back.
  struct Cover {
    std::uint32_t face = 0;
    int times = 0;
  };

  /// Returns the faces that cover the left and the right side of an edge, directed from its first
  /// to its second point and seen from the side to which the even faces' normals point. A face
  /// covers one place once, unless `cover_repeatedly_` is set, as outlines may cross themselves.
  std::array<std::vector<Cover>, 2> covering(const PointPair& edge,
                                             const std::vector<EdgeUse>& uses) const {
    std::array<std::vector<Cover>, 2> sides;
    const Vec2 &first = points_2d_.at(edge[0]), &second = points_2d_.at(edge[1]);
    const Vec2 middle = 0.5 * (first + second);
    const bool is_left = first.y() == second.y() ? first.x() < second.x() : first.y() > second.y();
    auto use = uses.begin();
    for (std::uint32_t i = 0; i < plane_.faces.size(); ++i) {
      int more_on_left = 0;
      if (use != uses.end() && use->face == i) {
        more_on_left = is_odd(i) ? -use->count : use->count;
        ++use;
      } else if (!boxes_[i].contains(middle)) {
        continue;
      }
      Cover left{i, 0}, right{i, 0};
      if (cover_repeatedly_) {
        const int beside = winding_beside(i, edge, middle);
        left.times = is_left ? beside : beside + more_on_left;
        right.times = left.times - more_on_left;
      } else if (more_on_left != 0) {
        (more_on_left > 0 ? left : right).times = 1;
      } else {
        left.times = right.times = winding_beside(i, edge, middle) % 2 != 0 ? 1 : 0;
      }
      if (left.times != 0) sides[0].push_back(left);
      if (right.times != 0) sides[1].push_back(right);
    }
    return sides;
  }

  /// Returns the faces that remain of those that cover a place: fronts cancel opposite fronts.
  std::vector<Cover> remaining(const std::vector<Cover>& covering) const {
    const auto is_up = [&](const Cover& cover) { return is_odd(cover.face) != (cover.times > 0); };
    int up = 0;
    for (const Cover& cover : covering)
      up += is_up(cover) ? std::abs(cover.times) : -std::abs(cover.times);
    std::vector<Cover> left;
    for (const Cover& cover : covering) {
      if (up == 0 || is_up(cover) != (up > 0)) continue;
      const int times = std::min(std::abs(cover.times), std::abs(up));
      left.push_back({cover.face, cover.times > 0 ? times : -times});
      up -= up > 0 ? times : -times;
    }
    return left;
  }

  /// Adds an edge to the outlines of the faces that remain on one side of it more often.
  void add_outline_edges(const PointPair& edge, const std::vector<EdgeUse>& uses) {
    const auto sides = covering(edge, uses);
    std::map<std::uint32_t, int> more_on_left;
    for (const Cover& cover : remaining(sides[0])) more_on_left[cover.face] += cover.times;
    for (const Cover& cover : remaining(sides[1])) more_on_left[cover.face] -= cover.times;
    for (const auto& [i, more] : more_on_left) {
      const bool along = (more > 0) != is_odd(i);
      const DirectedEdge directed =
          along ? DirectedEdge{edge[0], edge[1]} : DirectedEdge{edge[1], edge[0]};
      outlines_[i].insert(outlines_[i].end(), static_cast<std::size_t>(std::abs(more)), directed);
    }
  }

  /// Returns true if the remaining part of a face is the whole face.
  bool is_unchanged(std::uint32_t i) const {
    std::vector<PointPair> old_edges, new_edges;
    for (const PieceSurface::Contour& contour : face(i).contours) {
      for (std::size_t c = 0; c < contour.size(); ++c) {
        old_edges.push_back({contour[c].point, contour[c + 1 < contour.size() ? c + 1 : 0].point});
      }
    }
    for (const DirectedEdge& edge : outlines_[i]) new_edges.push_back({edge.from, edge.to});
    std::sort(old_edges.begin(), old_edges.end());
    std::sort(new_edges.begin(), new_edges.end());
    return old_edges == new_edges;
  }

  /// Replaces the contours of a face by those of what remains of it.
  void replace(std::uint32_t i) {
    if (is_unchanged(i)) return;
    PieceSurface::Face& of = face(i);
    std::vector<PieceSurface::Contour> contours;
    for (const std::vector<std::uint32_t>& points : contours_[i]) {
      contours.emplace_back();
      for (const std::uint32_t point : points) contours.back().push_back(corner(of, point));
      clean_contour(contours.back());
      if (contours.back().empty()) contours.pop_back();
    }
    of.contours = std::move(contours);
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
    const Vec2& origin = points_2d_.at(a->point);
    double farthest = 0, largest = 0;
    for (const PieceSurface::Contour& contour : of.contours) {
      for (const PieceSurface::Corner& known : contour) {
        const double distance = (points_2d_.at(known.point) - origin).norm();
        if (distance > farthest) {
          farthest = distance;
          b = &known;
        }
      }
    }
    for (const PieceSurface::Contour& contour : of.contours) {
      for (const PieceSurface::Corner& known : contour) {
        const double area =
            std::abs(cross(points_2d_.at(b->point) - origin, points_2d_.at(known.point) - origin));
        if (area > largest) {
          largest = area;
          c = &known;
        }
      }
    }
    if (c == nullptr) return {point, a->normal, a->uv};
    const Vec2 ab = points_2d_.at(b->point) - origin, ac = points_2d_.at(c->point) - origin;
    const Vec2 to = points_2d_.at(point) - origin;
    const auto s = static_cast<float>(cross(to, ac) / cross(ab, ac));
    const auto t = static_cast<float>(cross(ab, to) / cross(ab, ac));
    const Vec3f normal = (1 - s - t) * a->normal + s * b->normal + t * c->normal;
    const float length = normal.norm();
    return {point, length > 0 ? Vec3f(normal / length) : a->normal,
            (1 - s - t) * a->uv + s * b->uv + t * c->uv};
  }

  PieceSurface& surface_;
  const WallPlane& plane_;
  const bool cover_repeatedly_;              ///< True if a face may cover a place more than once.
  std::map<std::uint32_t, Vec2> points_2d_;  ///< Coordinates of points in the plane.
  std::map<PointPair, std::vector<EdgeUse>> edges_;
  std::vector<std::vector<DirectedEdge>> outlines_;  ///< Remaining outline of each face.
  std::vector<std::vector<std::vector<std::uint32_t>>> contours_;  ///< Outlines as contours.
  std::vector<Eigen::AlignedBox2d> boxes_;                         ///< Bounding box of each face.
};

}  // namespace

bool remove_common(PieceSurface& surface, const WallPlane& plane, bool cover_repeatedly) {
  return CommonRemover(surface, plane, cover_repeatedly).run();
}

}  // namespace sunder
