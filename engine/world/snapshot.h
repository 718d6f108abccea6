// Stage `snapshot`: the report of a frame, and the frame itself for those who draw or store it.
// Internal to engine/world.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/model/frame.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/particles/particle_stage.h"

namespace sunder {

/// Ends the current frame in the run log and returns its report, without what only a drawn frame
/// has: particles and penetrations. `mass_to_come_kg` is that of shots to come.
FrameReport end_frame(WorldState& world, double mass_to_come_kg, std::uint32_t carried_over);
/// Returns a new frame of the current state, with the report of the last one that ended.
std::shared_ptr<Frame> snapshot(WorldState& world, ParticleStage& particles,
                                const FrameReport& report);

}  // namespace sunder
