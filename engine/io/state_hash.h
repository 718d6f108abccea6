// Hash of the simulated state: equal for two runs if and only if they are the same.
#pragma once

#include <cstdint>

#include "engine/model/frame.h"

namespace sunder {

/// Returns the XXH3 hash of the frame's bodies (key, pose, velocities, sleep, bit for bit), and of
/// its debris and dust as recordings store them. A frame from a recording returns the hash that it
/// was recorded with.
std::uint64_t hash_state(const Frame& frame);

/// Returns the hash of one body's exact state.
std::uint64_t hash_body(const FrameBody& body);

}  // namespace sunder
