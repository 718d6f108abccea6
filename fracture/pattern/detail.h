// Detail of a pattern: the number of cells that the energy of an impact pays for.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Share of an impact's energy that goes into cracks; the rest stays in motion, or becomes heat. A
/// choice (docs/decisions/049).
inline constexpr double kCrackShare = 0.1;

/// Halves the number of cells until that share of the hit's energy pays for their cracks, or until
/// there are as few as can be. Cells of a given size, as bricks and those of a file, stay; so do
/// those of materials without a limit of stress, which the crack energy of the pattern decides.
/// `radius_m` is that of the impact sphere; `thickness_m` that of a plate, 0 for other convexes.
void reduce_to_energy(const Material& material, const StructureImpact& hit, double radius_m,
                      double thickness_m, PatternSpec& pattern);

}  // namespace sunder::fracture
