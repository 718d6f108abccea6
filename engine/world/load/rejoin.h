// What has bent becomes one again. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/model/breaker.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Two actors that hinges hold, none of which has flowed for a while, become one, if they can and
/// would bear, as one, what both do: a pair a step, the one that has been still for longest. What
/// has hardened may bear more in joints, and stays so. Returns the work that finding out took, as
/// StressAnswer has it.
///
/// What moves may part at once again, in the same place, by another load: so each time the wait is
/// twice as long.
std::uint64_t rejoin(World& world, const Breaker& breaker);

}  // namespace sunder
