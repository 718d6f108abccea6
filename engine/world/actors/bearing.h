// What an actor bears, as a breaker is asked about it. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Its own weight, its spin, and what presses on it; `loads` is where that is kept. How much work
/// the answer may take is the caller's to say.
LoadCase bearing(const World& world, const Actor& actor, const Quat& rotation_WB,
                 std::vector<Load>& loads);

}  // namespace sunder
