// Load case of an actor for the breaker. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/breaker.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Returns the load case of self-weight, spin, and contact and joint forces, without a limit of
/// work. `loads` receives the forces and must outlive the load case.
LoadCase make_load_case(const World& world, const Actor& actor, const Quat& rotation_WB,
                        std::vector<Load>& loads);

}  // namespace sunder
