// What a break does to an actor: pieces come off it. Internal to engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/world/actors/world.h"

namespace sunder {

/// Pieces that an edit makes of a structure, what stays of it included.
std::uint32_t pieces_after(const Structure& structure, const BreakEdit& edit);

/// Whether the limit of bodies allows for the pieces that come off, with so many others to come.
bool has_room(const World& world, const BreakEdit& edit, std::size_t to_come = 0);

/// The event of a break of an actor now, by whose material it broke; its pieces are not known yet.
BreakEvent break_of(const World& world, const Actor& actor, MaterialIndex material);

/// Breaks the actor `key`. One that is still anchored stays and loses what came off;
/// another gives way to its pieces, what stays of its structure first. Pieces move as it did (each
/// with its velocity field, so that linear and angular momentum stay); the smallest become debris.
/// Returns the keys of the pieces that are bodies, `key` first if the actor stays.
std::vector<std::uint64_t> carry_out(World& world, std::uint32_t key, BreakEdit& edit);

}  // namespace sunder
