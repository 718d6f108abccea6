// Actors come into the world: what they are made of, and bodies for the physics. Internal to
// engine/world.
#pragma once

#include <cstdint>
#include <span>

#include "engine/world/actors/world.h"

namespace sunder {

/// An actor with a new key and no body yet; anchored compounds become static.
Actor make_actor(World& world, const Compound& compound);
/// Its body, moving with the field (static bodies do not move).
BodyDesc describe(const World& world, const Actor& actor, const Motion& motion);
/// The shape of one of its convexes; its tag is the slot.
ShapeDesc shape_of(const World& world, const Actor& actor, ConvexSlot slot);
/// What it takes to break it, and that nothing presses on it yet. What is kinematic does not break.
void set_strength(const World& world, Actor& actor);
/// Volume of a solid within the impact radius of a material, at most.
double reached_m3(const Material& material, double volume_m3);
/// The least energy, impulse and speed that could break it, by pattern or by stress.
void set_least(const World& world, Actor& actor);

/// Give its body another motion, or an impulse from outside. The answer is by how much its kinetic
/// energy has grown, J.
double move_actor(World& world, const Actor& actor, const BodyState& state);
double push_actor(World& world, const Actor& actor, const Vec3& impulse_W, const Vec3& point_W);

void add_compounds(World& world, std::span<const Solid> solids);

void add_ball(World& world, const Ball& ball);

}  // namespace sunder
