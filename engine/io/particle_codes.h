// Integer codes of debris and dust for hashing and storage, at visually sufficient precision.
// Encoding a decoded particle gives its code again, so a stored frame has the hash of the original.
#pragma once

#include <array>
#include <cstdint>

#include "engine/model/frame.h"

namespace sunder {

/// Integers per particle: position, rotation, radius, material, and variant or opacity.
inline constexpr std::size_t kParticleNumbers = 10;
using ParticleCode = std::array<std::int32_t, kParticleNumbers>;

ParticleCode encode(const FrameDebris& chip);
ParticleCode encode(const FrameDust& puff);
FrameDebris decode_debris(const ParticleCode& code);
FrameDust decode_dust(const ParticleCode& code);

}  // namespace sunder
