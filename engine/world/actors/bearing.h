// What an actor bears, as a breaker is asked about it. Internal to engine/world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Work to reserve for an actor, in visits of each of its bonds; what is left over goes to others.
inline constexpr std::uint64_t kReserve = 300;

/// Its own weight, and what presses on it; `loads` is where these are kept.
LoadCase bearing(const World& world, const Actor& actor, const Quat& rotation_WB,
                 std::vector<Load>& loads);

}  // namespace sunder
