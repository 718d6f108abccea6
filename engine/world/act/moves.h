// What the script moves by keyframes: kinematic bodies on their paths. Internal to engine/world.
#pragma once

#include "engine/world/actors/world.h"

namespace sunder {

/// At the start: all that will be moved stands, of infinite mass, and does not break.
void take_hold(World& world);
/// Lets go of what is due, and gives the others the velocity that brings them to where their path
/// is at the end of this step.
void move_on(World& world);

}  // namespace sunder
