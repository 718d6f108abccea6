// Plastic hinges: yielding sections of solids, as joints between the bodies on both sides. Their
// joints are in joints.h. Internal to engine/world.
#pragma once

#include <cstdint>
#include <span>

namespace sunder {

struct Actor;
struct BreakEdit;
struct WorldState;

/// Adds the plastic hinges of an edit. The edit has been applied to `parent`; `piece_keys` are the
/// keys of its pieces as exposed faces number them: actors in `pieces`, or the parent.
void add_hinges(WorldState& world, const Actor& parent, const BreakEdit& edit,
                std::span<const Actor> pieces, std::span<const std::uint32_t> piece_keys);

/// Updates hinges after a solve: those that yielded harden, and those beyond their elongation tear.
void update_hinges(WorldState& world);

}  // namespace sunder
