// Makes the edit that separates a compound where bonds broke or flow.
#pragma once

#include <vector>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Returns the edit by which a structure, whose convexes have the given slots, becomes `compound`,
/// from which the bonds in `cut` and in `hinges` are removed already. Bonds and hinges have indices
/// of convexes; the pieces of hinges are set here. All islands but one come off, in the order of
/// their first convexes: the largest of those with an anchor stays, or the largest of all if none
/// has one.
BreakEdit separate_islands(const Compound& compound, const std::vector<ConvexSlot>& slots,
                           const std::vector<Bond>& cut, std::vector<PlasticHinge> hinges);

}  // namespace sunder::fracture
