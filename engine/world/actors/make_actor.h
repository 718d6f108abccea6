// Creation of actors and of their bodies for the physics. Internal to engine/world.
#pragma once

#include <span>

#include "engine/world/actors/world.h"

namespace sunder {

/// Returns an actor with a new key and without a body; anchored compounds become static.
Actor make_actor(World& world, const Compound& compound);
/// Returns the description of an actor's body, moving with the velocity field unless it is static.
BodyDesc make_body_desc(const World& world, const Actor& actor, const Motion& motion);
/// Returns the shape of a convex of an actor; its tag is the slot.
ShapeDesc shape_of(const World& world, const Actor& actor, ConvexSlot slot);
/// Sets the strength of an actor and clears its loads. Kinematic actors do not break.
void set_strength(const World& world, Actor& actor);
/// Returns the volume of a solid within the impact radius of a material, an upper bound.
double reached_m3(const Material& material, double volume_m3);
/// Sets the least energy, impulse and speed of an impact that can break an actor, by pattern or by
/// stress.
void set_least(const World& world, Actor& actor);
/// Counts the limits that an actor with a body of its own is made with: too many bonds for stress
/// by impacts, or too few convexes for stress by contacts.
void count_limits(World& world, const Actor& actor);

/// Sets the motion of an actor's body, or applies an external impulse. Returns the change of its
/// kinetic energy, J.
double move_actor(World& world, const Actor& actor, const BodyState& state);
double push_actor(World& world, const Actor& actor, const Vec3& impulse_W, const Vec3& point_W);

void add_compounds(World& world, std::span<const Solid> solids);

void add_ball(World& world, const Ball& ball);

}  // namespace sunder
