// Builds a compound of convexes that touch or overlap: coplanar faces get shared plane ids, faces
// that touch get bonds, and overlaps get ghosts.
#pragma once

#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

using sunder::Part;

/// Returns a compound of `parts`. Faces within `tolerance_m` of one plane share a plane id;
/// touching pairs get bonds, and parts that overlap by more than the tolerance get ghosts. Up to
/// kMaxConvexesPerGhost (overlap.h) parts may overlap in one place; of a further part only what the
/// parts before it do not fill is kept. Throws InputError if there are too many overlaps.
Compound make_compound(std::vector<Part> parts, double tolerance_m = 1e-6);

/// Returns the islands of a compound, in the order of their first convexes.
std::vector<Compound> split_islands(const Compound& compound);

}  // namespace sunder::fracture
