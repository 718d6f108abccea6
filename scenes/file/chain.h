// The chain of a wrecking ball.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/scene.h"

namespace sunder::scenes {

/// `count` links of the ball's material, each turned by a quarter against the next, from where the
/// shot hangs to the surface of its ball.
std::vector<Solid> make_chain(const Shot& shot, std::uint32_t count);

}  // namespace sunder::scenes
