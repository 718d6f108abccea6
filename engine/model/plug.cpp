#include <algorithm>

#include "engine/model/breaker.h"

namespace sunder {

double Plug::section_reach_m() const {
  double reach_m = 0;
  for (const Vec2& corner : section_m) reach_m = std::max(reach_m, corner.norm());
  return reach_m;
}

bool Plug::contains(const Vec3& point_P) const {
  for (std::size_t i = 0; i < section_m.size(); ++i) {
    const Vec2& a = section_m[i];
    const Vec2 along = section_m[(i + 1) % section_m.size()] - a;
    const Vec2 to = Vec2(point_P.x(), point_P.z()) - a;
    if (along.x() * to.y() - along.y() * to.x() < 0) return false;
  }
  return !section_m.empty() && (through || (point_P.y() >= 0 && point_P.y() <= depth_m));
}

}  // namespace sunder
