// What happens inside, for debug views. Internal to engine/world.
#pragma once

#include <memory>

#include "engine/model/breaker.h"
#include "engine/model/frame.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Of the frame that has just been taken of the world; changes nothing. What load does is worked
/// out anew for every solid that it can break, which may take longer than the frame did.
std::shared_ptr<const Inspection> inspect(const World& world, const Breaker& breaker,
                                          const Frame& frame);

}  // namespace sunder
