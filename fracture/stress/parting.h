// What comes off a compound whose bonds gave way, as an edit of the structure that it is of.
#pragma once

#include <vector>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// The edit by which a structure, with these slots, becomes `compound`: which has neither the bonds
/// that are `cut` nor those of `hinges`. Bonds and hinges are given by its convexes, the pieces of
/// hinges not at all. Islands but one come off, in the order of their first convex; the largest of
/// those that are anchored stays, or of all if none is.
BreakEdit part(const Compound& compound, const std::vector<ConvexSlot>& slots,
               const std::vector<Bond>& cut, std::vector<PlasticHinge> hinges);

}  // namespace sunder::fracture
