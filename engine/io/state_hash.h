// Hash of the simulated state. Equal states have equal hashes, and different states different ones,
// except for collisions.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/model/frame.h"

namespace sunder {

/// Returns the XXH3 hash of the frame's index, of its bodies (key, pose, velocities, and whether
/// each is static or asleep; every bit counts), and of its debris and dust, rounded as in a
/// recording. For a frame read from a recording, returns its `recorded_hash`.
std::uint64_t hash_state(const Frame& frame);

/// Returns the hash of the same fields of one body.
std::uint64_t hash_body(const FrameBody& body);

/// Returns the hash of a run, 16 hexadecimal digits, from the hashes of its states.
std::string hash_run(std::span<const std::uint64_t> states);

}  // namespace sunder
