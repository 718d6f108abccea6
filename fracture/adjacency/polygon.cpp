#include "fracture/adjacency/polygon.h"

#include <algorithm>
#include <utility>

namespace sunder::fracture {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

double polygon_area(std::span<const Vec2> polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * twice;
}

double overlap_area(std::span<const Vec2> a, std::span<const Vec2> b, OverlapScratch& scratch) {
  std::vector<Vec2>& current = scratch.current;
  std::vector<Vec2>& next = scratch.next;
  current.assign(a.begin(), a.end());
  for (std::size_t e = 0; e < b.size(); ++e) {
    const Vec2& start = b[e];
    const Vec2 along = b[e + 1 < b.size() ? e + 1 : 0] - start;
    next.clear();
    double before = cross(along, current.back() - start);
    Vec2 from = current.back();
    for (const Vec2& to : current) {
      const double after = cross(along, to - start);
      if ((before < 0) != (after < 0))
        next.push_back(from + before / (before - after) * (to - from));
      if (after >= 0) next.push_back(to);
      before = after;
      from = to;
    }
    if (next.size() < 3) return 0;
    std::swap(current, next);
  }
  return std::max(0.0, polygon_area(current));
}

}  // namespace sunder::fracture
