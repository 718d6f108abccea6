// Debris and dust as they are hashed and stored: whole numbers, as fine as the eye needs. Coding
// what was decoded gives the same code, so a stored frame has the hash of the frame it was.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/model/frame.h"

namespace sunder {

/// Numbers that code one particle: position, rotation, radius, what it is.
inline constexpr std::size_t kParticleNumbers = 10;
using ParticleCode = std::array<std::int32_t, kParticleNumbers>;

ParticleCode encode(const FrameDebris& chip);
ParticleCode encode(const FrameDust& puff);
FrameDebris decode_debris(const ParticleCode& code);
FrameDust decode_dust(const ParticleCode& code);

}  // namespace sunder
