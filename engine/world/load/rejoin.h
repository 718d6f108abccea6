// Rejoining of bodies at bent plastic hinges. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/model/breaker.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Merges two actors that hinges hold, if none of the hinges has yielded for a while and the merged
/// actor withstands the loads of both. One pair a step: the one at rest for longest. A hardened
/// section may bear more as a joint, and then stays one. Returns the work in bond evaluations, as
/// StressResult does. A merged body under changing loads may part again at once at the same place:
/// each time the delay doubles.
std::uint64_t rejoin(WorldState& world, const Breaker& breaker);

}  // namespace sunder
