// Sections of the running world that flow: bodies held together by what a section of them bears.
// Internal to engine/world. Who holds whom is in joints.h.
#pragma once

#include <cstdint>
#include <span>

namespace sunder {

struct Actor;
struct BreakEdit;
struct World;

/// Joins what an edit holds together by sections. It was applied to `parent`; its pieces are the
/// actors with these keys, as exposed faces name them, of `pieces`, or the parent.
void join_hinges(World& world, const Actor& parent, const BreakEdit& edit,
                 std::span<const Actor> pieces, std::span<const std::uint32_t> piece_keys);

/// After a solve: hinges that flowed harden, and those that are drawn out too far tear.
void flow(World& world);

}  // namespace sunder
