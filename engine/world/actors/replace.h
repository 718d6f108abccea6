// Breaking of actors into pieces. Internal to engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Returns the number of pieces after an edit of a structure, crushed ones excluded, the remaining
/// structure included.
std::uint32_t pieces_after(const Structure& structure, const BreakEdit& edit);

/// Returns true if the limit of bodies allows the pieces of an edit, with `pieces_planned` other
/// pieces planned.
bool fits_body_limit(const WorldState& world, const BreakEdit& edit,
                     std::size_t pieces_planned = 0);

/// Returns a new event for a break of an actor, at present, in this material; without its pieces.
BreakEvent make_break_event(const WorldState& world, const Actor& actor, MaterialIndex material);

/// Breaks the actor `key`. If it is still anchored, it stays without the pieces; otherwise it is
/// replaced by its pieces, the remaining structure first. Pieces keep the parent's velocity field,
/// which conserves linear and angular momentum; the smallest and the crushed become debris. Returns
/// the keys of the pieces that are bodies, `key` first if the actor stays.
std::vector<std::uint64_t> apply_break(WorldState& world, std::uint32_t key, BreakEdit& edit);

}  // namespace sunder
