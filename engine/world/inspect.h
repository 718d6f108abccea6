// Data for debug views. Internal to engine/world.
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "engine/model/frame.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Returns the inspection of a frame just taken of the world, which stays unchanged. The stress of
/// all solids that load can break is computed anew, which may take longer than the frame did.
std::shared_ptr<const Inspection> inspect(const WorldState& world, const Breaker& breaker,
                                          const Frame& frame);

}  // namespace sunder
