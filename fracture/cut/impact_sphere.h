// Where a fracture reaches.
#pragma once

#include <vector>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// What a break may change: convexes outside stay as they are.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;  ///< Infinity: everything breaks.

  /// Whether everything breaks.
  bool is_endless() const;
  /// Whether a convex reaches into it.
  bool touches(const Convex& convex) const;
  /// Slots of a structure whose convexes it touches, ascending.
  std::vector<ConvexSlot> touched(const Structure& structure) const;
};

}  // namespace sunder::fracture
