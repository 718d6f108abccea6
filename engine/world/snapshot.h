// Stage `snapshot`: the frame as it stands, for the sinks. Internal to engine/world.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/model/frame.h"
#include "engine/model/scene.h"
#include "engine/world/actors/world.h"
#include "engine/world/particles/particle_stage.h"

namespace sunder {

/// Takes what the ledger has of the frame. Mass counts `shots_to_come`.
std::shared_ptr<Frame> snapshot(World& world, ParticleStage& particles,
                                std::span<const Shot> shots_to_come, std::uint32_t carried_over);

}  // namespace sunder
