// Checks of a world that was read from a saved state: what its records say of each other. Internal
// to engine/world.
#pragma once

#include "engine/world/actors/impact.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Returns the name of a field of the world that is wrong; null if none is.
const char* wrong_field(const WorldState& world);

/// Returns true if the actor that is struck, if it is still there, has the struck convexes.
bool is_possible(const WorldState& world, const ActorImpact& impact);

}  // namespace sunder
