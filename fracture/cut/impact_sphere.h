// Where a fracture reaches.
#pragma once

#include <vector>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// What a break may change: convexes outside stay as they are, and so do those of materials that do
/// not break.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;                          ///< Infinity: everything breaks that may.
  std::vector<MaterialIndex> unbreakable = {};  ///< Materials that do not break.
  double smallest_m3 = 0;  ///< Nor does what is smaller and overlaps one that does not.

  /// Whether everything breaks that may.
  bool is_endless() const;
  /// Whether convexes of a material stay whole.
  bool spares(MaterialIndex material) const;
  /// Whether a convex that may break reaches into it.
  bool touches(const Convex& convex) const;
  /// Whether a convex is a lump that one which does not break holds.
  bool is_lump(const Structure& structure, ConvexSlot slot) const;
  /// Slots of a structure whose convexes it touches and breaks, ascending.
  std::vector<ConvexSlot> touched(const Structure& structure) const;
};

}  // namespace sunder::fracture
