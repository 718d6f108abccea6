// Joints of the running world: who they hold, and where they go when that breaks. Internal to
// engine/world.
#pragma once

#include <span>

#include "engine/world/actors/world.h"

namespace sunder {

/// Joins two things as they stand; `joint.a` and `joint.b` are keys here.
void add_joint(World& world, const Joint& joint);
/// A shot ball on its rope, or on its chain, which appears with it.
void hang(World& world, const Shot& shot);
/// After `parent` gave way to pieces, or lost them and stays: its ends go to what has the anchor
/// now, and joints without one are cut and counted.
void move_joints(World& world, const Actor& parent, bool stays, std::span<const Actor> pieces);
/// Before actors go: their joints are cut and counted.
void cut_joints(World& world, std::uint32_t key);
/// Keys of what a joint that does not give holds to the world, or to what the world holds;
/// ascending.
std::vector<std::uint32_t> fixed_to_world(const World& world);
/// After a solve: counts what broke under its load.
void note_broken_joints(World& world);

}  // namespace sunder
