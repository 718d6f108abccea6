// Stage `snapshot`: makes a frame of the current state, for the sinks. Internal to engine/world.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/model/frame.h"
#include "engine/model/scene.h"
#include "engine/world/actors/world.h"
#include "engine/world/particles/particle_stage.h"

namespace sunder {

/// Returns a new frame, and resets the counts of the current frame in the run log. The
/// mass of `shots_to_come` is included.
std::shared_ptr<Frame> snapshot(World& world, ParticleStage& particles,
                                std::span<const Shot> shots_to_come, std::uint32_t carried_over);

}  // namespace sunder
