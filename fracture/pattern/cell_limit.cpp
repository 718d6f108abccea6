#include "fracture/pattern/cell_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/roots.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

using Kind = PatternSpec::Kind;

/// The part of a solid that a pattern breaks.
struct BrokenPart {
  double volume_m3 = 0;    ///< Volume of the solid within the impact sphere.
  double sphere_m3 = 0;    ///< Volume of the sphere, or of the solid if all of it breaks.
  double thickness_m = 0;  ///< Thickness of a plate; 0 for other solids.

  /// Radius of the part of a plate, or of a solid as a cylinder of the depth below.
  double radius_m() const { return std::sqrt(volume_m3 / (std::numbers::pi * depth_m())); }
  /// Depth along the axis of webs and sectors.
  double depth_m() const { return thickness_m > 0 ? thickness_m : cube_root(volume_m3); }
};

/// Returns the area of the cracks between the cells of a pattern, each counted once.
double crack_m2(const PatternSpec& pattern, const BrokenPart& broken) {
  const double cells = pattern.cells;
  switch (pattern.kind) {
    case Kind::kWeb:  // Rings have half the radius on average.
      return (pattern.spokes + std::numbers::pi * pattern.rings) * broken.radius_m() *
             broken.depth_m();
    case Kind::kRadial:
      return cells * broken.radius_m() * broken.depth_m();
    case Kind::kSlabs:
      return cells * cube_root(broken.volume_m3 * broken.volume_m3);
    case Kind::kGrid:
      return 3 * cells * broken.volume_m3 / cube_root(broken.sphere_m3);
    default:  // Half the mean surface of a Poisson-Voronoi cell, which is 5.82 of its volume^(2/3).
      return 2.91 * cube_root(cells / broken.sphere_m3) * broken.volume_m3;
  }
}

/// Halves the number of cells; returns false if it is the least possible already.
bool halve(PatternSpec& pattern) {
  const PatternSpec before = pattern;
  const int least = pattern.kind == Kind::kRadial ? 3 : 2;
  if (pattern.kind == Kind::kWeb) {
    pattern.rings = std::max(1, pattern.rings / 2);
    pattern.spokes = std::max(3, pattern.spokes / 2);
    return pattern.rings < before.rings || pattern.spokes < before.spokes;
  }
  pattern.cells = std::max(std::min(least, before.cells), before.cells / 2);
  return pattern.cells < before.cells;
}

}  // namespace

void limit_cells_by_energy(const Material& material, const StructureImpact& hit, double radius_m,
                           double thickness_m, PatternSpec& pattern) {
  if (pattern.kind == Kind::kNone || pattern.kind == Kind::kBrick || pattern.kind == Kind::kFile)
    return;
  if (!(material.toughness_J_m2 > 0) || !(hit.reached_m3 > 0)) return;
  if (!(material.impact_limit_Pa(true) > 0)) return;
  BrokenPart broken{hit.reached_m3, hit.reached_m3, thickness_m};
  if (std::isfinite(radius_m)) {
    broken.sphere_m3 = 4.0 / 3 * std::numbers::pi * radius_m * radius_m * radius_m;
    broken.volume_m3 = std::min(hit.reached_m3, broken.sphere_m3);
  }
  const double affordable_m2 = kCrackShare * hit.energy_J / material.toughness_J_m2;
  while (crack_m2(pattern, broken) > affordable_m2 && halve(pattern)) {
  }
}

}  // namespace sunder::fracture
