// Joins two solids, held together by plastic hinges while they bent, into one again.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Implements Breaker::rejoin(). The solids stay separate if they are bent too far for a mitre
/// joint, or if a convex that the mitre changes overlaps another or would lose its anchor.
Rejoined rejoin_bent(const BentPair& bent);

}  // namespace sunder::fracture
