// Convexes that touch become a compound: coplanar faces get shared plane ids, overlaps bonds.
#pragma once

#include <vector>

#include "engine/world/compound.h"

namespace sunder::fracture {

/// A compound of convexes that do not overlap. Faces within `tolerance_m` of one plane share a
/// plane id; touching pairs become bonds. `anchored` is empty or one flag per convex.
Compound make_compound(std::vector<ConvexPolyhedron> polyhedra, MaterialIndex material,
                       std::vector<std::uint8_t> anchored = {}, double tolerance_m = 1e-6);

}  // namespace sunder::fracture
