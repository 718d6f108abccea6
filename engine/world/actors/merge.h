// Two actors become one. Internal to engine/world.
#pragma once

#include <cstdint>

#include "engine/world/actors/world.h"

namespace sunder {

/// Actor `key` takes in actor `other`, as `rejoined` says, whose rest frame has the pose X_AB in
/// that of `key`. The other is gone then, and so are joints between them; those of both go on. One
/// that is static stays as it is; momentum and angular momentum are kept.
void merge(World& world, std::uint32_t key, std::uint32_t other, const Rejoined& rejoined,
           const Pose& X_AB);

}  // namespace sunder
