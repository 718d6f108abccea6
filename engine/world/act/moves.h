// Moves of the script: kinematic bodies that follow keyframes. Internal to engine/world.
#pragma once

#include "engine/world/actors/world.h"

namespace sunder {

/// Makes all bodies with moves kinematic, at the start: of infinite mass, and unbreakable.
void start_moves(World& world);
/// Releases the bodies that are due, and gives the others the velocity to their pose at the end of
/// the step.
void update_moves(World& world);

}  // namespace sunder
