// Blasts: an impulse on every face turned to the centre, decreasing with distance and angle; for a
// charge of TNT, that of its blast wave (charge.h). Internal to engine/world.
//
// The break stage decides the breaks of a blast. By pattern: from the energy that the impulse would
// give to the convexes if they were free, for a few steps at one point of each solid, that of the
// largest impulse first. By stress: from the bending by all impulses on a solid, once, and again
// after it has broken. Then the impulse acts on all movable bodies. Walls give cover if the blast
// says so (cover.h): what they covered when they broke stays covered as long as they are in the
// way.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "engine/world/actors/impact.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// A blast in progress: it breaks one point of each solid a step, then applies its impulse.
struct ActiveBlast {
  Blast blast;
  double impulse_time_s = 0;
  std::vector<Vec3> tried_points_W;  ///< Points where it has tried to break something.
  std::uint32_t number = 0;          ///< Unique in a run.
  /// By actor: number of edits when its bending was last planned.
  std::map<std::uint32_t, std::uint32_t> bent = {};
};

/// Begins a blast; `number` is unique in a run.
ActiveBlast start_blast(const WorldState& world, Blast blast, std::uint32_t number);
/// Returns the impacts of a blast: by pattern, at each actor's untried point of largest impulse; by
/// stress, with all impulses on each actor that has been edited since the last time. Records both
/// in `active`, and counts the work.
std::vector<ActorImpact> find_blast_impacts(WorldState& world, ActiveBlast& active);
/// Applies the impulse of a blast to all movable actors and to the chips of this frame.
void apply_blast_impulses(WorldState& world, const Blast& blast);

}  // namespace sunder
