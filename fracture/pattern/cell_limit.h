// Limits the number of cells of a pattern to what the energy of an impact can crack.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Halves the number of cells until kCrackShare of the hit's energy pays for their cracks, or the
/// number is the least possible. Cells of fixed size (bricks, cells from files) are not changed,
/// nor are the patterns of materials without a limit of stress, which break by crack energy alone.
/// `radius_m` is the radius of the impact sphere; `thickness_m` the thickness of a plate, 0 for
/// other convexes.
void limit_cells_by_energy(const Material& material, const StructureImpact& hit, double radius_m,
                           double thickness_m, PatternSpec& pattern);

}  // namespace sunder::fracture
