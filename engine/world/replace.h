// A broken solid gives way to its pieces. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/world/world.h"

namespace sunder {

/// Whether the limit of bodies allows for the pieces; counts it as hit if not.
bool has_room(World& world, const BreakPlan& plan);

/// Puts the pieces in the place of the actor `key`, moving as it did (each with the parent's
/// velocity field, so that linear and angular momentum stay); the smallest become debris.
void replace_by_pieces(World& world, std::uint32_t key, BreakPlan& plan);

}  // namespace sunder
