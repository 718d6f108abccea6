// A fracture event, whole or partial (paper 3.1 and 3.2), as five steps:
//
//   align      (align.h)      the pattern is moved onto the impact
//   intersect  (intersect.h)  convexes within reach are cut by its cells
//   weld       (weld.h)       covered cells become one convex
//   group      (fracture.cpp) what lies in one cell, or colour, goes together; the rest stays
//   islands    (islands.h)    what no longer touches parts company
#pragma once

#include "engine/world/breaker.h"
#include "fracture/align.h"

namespace sunder::fracture {

/// Where a fracture reaches: convexes outside stay as they are.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;  ///< Infinity: everything breaks.

  bool is_endless() const;
  bool touches(const Convex& convex) const;
};

/// Breaks `compound` by a pattern at its place. Gives the compound back as it was, if nothing came
/// off.
BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event);

}  // namespace sunder::fracture
