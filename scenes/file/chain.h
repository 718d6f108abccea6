// The chain of a wrecking ball.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/scene.h"

namespace sunder::scenes {

/// Returns `count` links of the ball's material, from the suspension point of the shot to the
/// surface of its ball, each turned by 90° relative to the one before.
std::vector<Solid> make_chain(const Shot& shot, std::uint32_t count);

}  // namespace sunder::scenes
