// Blasts: an impulse on every face that sees the centre, less with distance and slant; that of a
// charge of TNT, if the blast has one (charge.h). Internal to engine/world.
//
// What a blast can break is decided by the break stage. By pattern, from the energy that its
// impulse would give the convexes it meets if they were free: for a few steps one place of each
// solid, the hardest pressed first. By stress, from what all impulses on a solid bend it by: once,
// and anew after it has broken. Then all that is loose is pushed. Walls give cover if the blast
// says so (cover.h): what they hid when it broke them stays hidden as long as they are in the way.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "engine/world/actors/impact.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// A blast under way: it breaks, one place of each solid a step, then it pushes.
struct Burst {
  Blast blast;
  double pushes_at_s = 0;
  std::vector<Vec3> tried_W;  ///< Where it has broken something, or failed to.
  std::uint32_t number = 0;   ///< Of the scene's.
  std::map<std::uint32_t, std::uint32_t> bent = {};  ///< By actor: its edits when it was pushed.
};

/// One of the scene's.
Burst light(const World& world, const Blast& blast);
/// What it does to each actor where it presses hardest and has not been tried, and to all of one
/// that it has not bent as it is; which is noted.
std::vector<Impact> blows_of(const World& world, Burst& burst);
/// Pushes all that is loose, chips that have just come off with it.
void push_by(World& world, const Blast& blast);

}  // namespace sunder
