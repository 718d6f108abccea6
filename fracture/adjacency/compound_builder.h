// Convexes that touch or overlap become a compound: coplanar faces get shared plane ids, faces that
// touch bonds, and what overlaps ghosts.
#pragma once

#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

using sunder::Part;

/// A compound of parts. Faces within `tolerance_m` of one plane share a plane id; touching pairs
/// become bonds, and parts that overlap by more than the tolerance ghosts. Up to kDeepestGhost
/// (overlap.h) parts may overlap in one place; a part that would be one more is cut, and keeps what
/// those before it do not fill. Throws InputError if overlaps are too many.
Compound make_compound(std::vector<Part> parts, double tolerance_m = 1e-6);

/// The connected parts of a compound, in the order of their first convexes; itself if it is one.
std::vector<Compound> split_islands(const Compound& compound);

}  // namespace sunder::fracture
