// A hash of everything simulated: two runs are the same iff their hashes are.
#pragma once

#include <cstdint>

#include "engine/model/frame.h"

namespace sunder {

/// Hash (XXH3) of the frame's bodies (key, pose, velocities, sleep, bit for bit), and of its debris
/// and dust as takes store them. That of a frame from a take is the one it was recorded with.
std::uint64_t hash_state(const Frame& frame);

/// Hash of one body's exact state.
std::uint64_t hash_body(const FrameBody& body);

}  // namespace sunder
