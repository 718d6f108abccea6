// Drawing of bent plastic hinges. Internal to engine/world.
#pragma once

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Redraws each hinge that has bent since it was last drawn: both sides end in the plane midway
/// between them, as they will when they are rejoined, so that no gap opens and rejoining changes
/// nothing visible.
void draw_bends(WorldState& world);

}  // namespace sunder
