// Area of the intersection of two polygons by a sweep over strips: between two successive heights
// of corners and crossings each polygon is a row of trapezoids, and the area is the height times
// the common width at mid-height. Most pairs have identical contours, which need no sweep.
#include "fracture/adjacency/polygon_overlap.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "fracture/adjacency/polygon.h"

namespace sunder::fracture {
namespace {

struct Edge {
  Vec2 low, high;
  bool of_b = false;

  double at(double y) const {
    return low.x() + (y - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
  }
};

class StripSweep {
 public:
  StripSweep(Contours a, Contours b) {
    const auto [low_a, high_a] = add(a, false);
    const auto [low_b, high_b] = add(b, true);
    low_ = std::max(low_a, low_b);
    high_ = std::min(high_a, high_b);
  }

  double area() {
    if (!(low_ < high_)) return 0;
    std::vector<double> heights{low_, high_};
    for (const Edge& edge : edges_) {
      for (const double y : {edge.low.y(), edge.high.y()}) {
        if (y > low_ && y < high_) heights.push_back(y);
      }
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    std::sort(edges_.begin(), edges_.end(),
              [](const Edge& p, const Edge& q) { return p.low.y() < q.low.y(); });
    double sum = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      const double bottom = heights[i], top = heights[i + 1];
      while (next < edges_.size() && edges_[next].low.y() <= bottom) {
        active_.push_back(edges_[next++]);
      }
      std::erase_if(active_, [&](const Edge& edge) { return edge.high.y() <= bottom; });
      sum += strip(bottom, top);
    }
    return sum;
  }

 private:
  /// Adds the edges of a polygon and returns its lowest and highest coordinate.
  std::pair<double, double> add(Contours contours, bool of_b) {
    double low = 1e300, high = -1e300;
    for (const std::span<const Vec2> contour : contours) {
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const Vec2 &p = contour[i], &q = contour[i + 1 < contour.size() ? i + 1 : 0];
        low = std::min(low, p.y());
        high = std::max(high, p.y());
        if (p.y() < q.y()) edges_.push_back({p, q, of_b});
        if (p.y() > q.y()) edges_.push_back({q, p, of_b});
      }
    }
    return {low, high};
  }

  /// Returns the overlap between two heights without a corner in between.
  double strip(double bottom, double top) {
    crossings_ = {0, 1};
    for (const Edge& p : active_) {
      for (const Edge& q : active_) {
        if (p.of_b || !q.of_b) continue;
        const double before = p.at(bottom) - q.at(bottom), after = p.at(top) - q.at(top);
        if ((before < 0) != (after < 0)) crossings_.push_back(before / (before - after));
      }
    }
    std::sort(crossings_.begin(), crossings_.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < crossings_.size(); ++i) {
      const double part = crossings_[i + 1] - crossings_[i];
      if (!(part > 0)) continue;
      const double middle = 0.5 * (crossings_[i] + crossings_[i + 1]);
      sum += part * common_length(bottom + middle * (top - bottom));
    }
    return sum * (top - bottom);
  }

  /// Returns the length that a horizontal line has in both polygons.
  double common_length(double y) {
    for (auto& places : places_) places.clear();
    for (const Edge& edge : active_) places_[edge.of_b ? 1 : 0].push_back(edge.at(y));
    for (auto& places : places_) std::sort(places.begin(), places.end());
    const auto &a = places_[0], &b = places_[1];
    double sum = 0;
    for (std::size_t i = 0, j = 0; i + 1 < a.size() && j + 1 < b.size();) {
      sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
      if (a[i + 1] < b[j + 1]) {
        i += 2;
      } else {
        j += 2;
      }
    }
    return sum;
  }

  double low_ = 0, high_ = 0;
  std::vector<Edge> edges_, active_;
  std::vector<double> crossings_;
  std::array<std::vector<double>, 2> places_;
};

bool are_identical(std::span<const Vec2> a, std::span<const Vec2> b, double tolerance) {
  if (a.size() != b.size()) return false;
  const auto same = [&](const Vec2& p, const Vec2& q) {
    return (p - q).squaredNorm() <= tolerance * tolerance;
  };
  std::size_t start = 0;
  while (start < b.size() && !same(a[0], b[start])) ++start;
  if (start == b.size()) return false;
  for (const Vec2& point : a) {
    if (!same(point, b[start])) return false;
    if (++start == b.size()) start = 0;
  }
  return true;
}

bool has_identical(std::span<const Vec2> contour, Contours others, double tolerance) {
  return std::any_of(others.begin(), others.end(), [&](std::span<const Vec2> other) {
    return are_identical(contour, other, tolerance);
  });
}

}  // namespace

double overlap_area(Contours a, Contours b, double tolerance) {
  if (a.size() != b.size()) return StripSweep(a, b).area();
  double area = 0;
  for (const std::span<const Vec2> contour : a) {
    if (!has_identical(contour, b, tolerance)) return StripSweep(a, b).area();
    area += polygon_area(contour);
  }
  return std::max(0.0, area);
}

}  // namespace sunder::fracture
