#include "fracture/pattern/detail.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::fracture {
namespace {

using Kind = PatternSpec::Kind;

/// The size of the part of a solid that a pattern breaks up.
struct Reached {
  double volume_m3 = 0;    ///< Of the solid within the impact sphere,
  double sphere_m3 = 0;    ///< and of the sphere; that of the solid if it breaks as a whole.
  double thickness_m = 0;  ///< Of a plate, else 0.

  /// Radius of the part of a plate, or of other solids about their middle.
  double radius_m() const { return std::sqrt(volume_m3 / (std::numbers::pi * depth_m())); }
  /// Along the axis of webs and sectors.
  double depth_m() const { return thickness_m > 0 ? thickness_m : std::cbrt(volume_m3); }
};

/// Area of the cracks between the cells of a pattern, counted once.
double crack_m2(const PatternSpec& pattern, const Reached& reached) {
  const double cells = pattern.cells;
  switch (pattern.kind) {
    case Kind::kWeb:  // rings of half the radius on average
      return (pattern.spokes + std::numbers::pi * pattern.rings) * reached.radius_m() *
             reached.depth_m();
    case Kind::kRadial:
      return cells * reached.radius_m() * reached.depth_m();
    case Kind::kSlabs:
      return cells * std::cbrt(reached.volume_m3 * reached.volume_m3);
    case Kind::kGrid:
      return 3 * cells * reached.volume_m3 / std::cbrt(reached.sphere_m3);
    default:  // half of the mean surface of a Poisson-Voronoi cell, 5.82 of its volume^(2/3)
      return 2.91 * std::cbrt(cells / reached.sphere_m3) * reached.volume_m3;
  }
}

/// Returns false if there are as few as can be.
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

void reduce_to_energy(const Material& material, const StructureImpact& hit, double radius_m,
                      double thickness_m, PatternSpec& pattern) {
  if (pattern.kind == Kind::kNone || pattern.kind == Kind::kBrick || pattern.kind == Kind::kFile)
    return;
  if (!(material.toughness_J_m2 > 0) || !(hit.reached_m3 > 0)) return;
  if (!(material.impact_limit_Pa(true) > 0)) return;
  Reached reached{hit.reached_m3, hit.reached_m3, thickness_m};
  if (std::isfinite(radius_m)) {
    reached.sphere_m3 = 4.0 / 3 * std::numbers::pi * radius_m * radius_m * radius_m;
    reached.volume_m3 = std::min(hit.reached_m3, reached.sphere_m3);
  }
  const double affordable_m2 = kCrackShare * hit.energy_J / material.toughness_J_m2;
  while (crack_m2(pattern, reached) > affordable_m2 && halve(pattern)) {
  }
}

}  // namespace sunder::fracture
