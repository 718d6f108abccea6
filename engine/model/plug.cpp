#include <algorithm>

#include "engine/model/breaker.h"

namespace sunder {
namespace {

/// Returns true if a point is in the prism of a plug whose section is scaled.
bool is_in_prism(const Plug& plug, double scale, const Vec3& point_P) {
  const std::vector<Vec2>& section_m = plug.section_m;
  for (std::size_t i = 0; i < section_m.size(); ++i) {
    const Vec2& a = section_m[i];
    const Vec2 along = section_m[(i + 1) % section_m.size()] - a;
    const Vec2 to = Vec2(point_P.x(), point_P.z()) - scale * a;
    if (along.x() * to.y() - along.y() * to.x() < 0) return false;
  }
  const bool is_beside = point_P.y() >= 0 && point_P.y() <= plug.depth_m;
  return !section_m.empty() && (plug.through || is_beside);
}

}  // namespace

double Plug::section_reach_m() const {
  double reach_m = 0;
  for (const Vec2& corner : section_m) reach_m = std::max(reach_m, corner.norm());
  return reach_m;
}

bool Plug::contains(const Vec3& point_P) const { return is_in_prism(*this, 1, point_P); }

bool Plug::crushes(const Vec3& point_P) const {
  return is_in_prism(*this, clearance, point_P) && !contains(point_P);
}

}  // namespace sunder
