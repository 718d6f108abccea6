// Hinges are drawn as they bend. Internal to engine/world.
#pragma once

#include "engine/world/actors/world.h"

namespace sunder {

/// Draws both sides of every hinge that has bent since it was last drawn as ending midway between
/// them, as they will once they are one again: no gap opens, and nothing jumps then.
void draw_bends(World& world);

}  // namespace sunder
