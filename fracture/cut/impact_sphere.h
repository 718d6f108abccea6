// The volume in which a fracture breaks convexes.
#pragma once

#include <vector>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// The convexes that a break may change: those in the sphere whose materials break. All others stay
/// the same objects.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;                          ///< Infinity: all that is breakable breaks.
  std::vector<MaterialIndex> unbreakable = {};  ///< Materials that do not break.
  /// Smaller convexes that overlap an unbreakable one do not break either.
  double smallest_m3 = 0;

  /// Returns true if the radius is infinite: all that is breakable breaks.
  bool is_infinite() const;
  /// Returns true if convexes of a material stay whole.
  bool is_unbreakable(MaterialIndex material) const;
  /// Returns true if a convex is breakable and reaches into the sphere.
  bool touches(const Convex& convex) const;
  /// Returns true if a convex is smaller than `smallest_m3` and overlaps an unbreakable one.
  bool is_small_and_held(const Structure& structure, ConvexSlot slot) const;
  /// Returns the slots of a structure whose convexes the sphere touches and breaks, ascending.
  std::vector<ConvexSlot> touched(const Structure& structure) const;
};

}  // namespace sunder::fracture
