// Merging of two actors. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Merges actor `other`, whose rest frame has the pose X_AB in that of `key`, into actor `key` by
/// `rejoined`, and erases it. Joints between the two are removed, those with others stay. A static
/// actor stays as it is; momentum and angular momentum are conserved.
void merge(WorldState& world, std::uint32_t key, std::uint32_t other, const Rejoined& rejoined,
           const Pose& X_AB);

}  // namespace sunder
