// Where a fracture reaches.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// Convexes outside stay as they are.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;  ///< Infinity: everything breaks.

  bool is_endless() const;
  bool touches(const Convex& convex) const;
  /// Slots of a structure whose convexes it touches, ascending.
  std::vector<std::uint32_t> touched(const Structure& structure) const;
};

}  // namespace sunder::fracture
