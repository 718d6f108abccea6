// Two solids that sections held together while they bent become one again.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// See Breaker::rejoin(). They stay two where they are bent too far for a mitre, or where what the
/// bend reaches overlaps something, or would be let go by what the world holds it by.
Rejoined rejoin_bent(const BentPair& bent);

}  // namespace sunder::fracture
