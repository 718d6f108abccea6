// Creation of actors and of their bodies for the physics. Internal to engine/world.
#pragma once

#include <span>
#include <vector>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Returns an actor with a new key and without a body; anchored compounds become static.
Actor make_actor(WorldState& world, const Compound& compound);
/// `structure` is that of the compound.
Actor make_actor(WorldState& world, const Compound& compound, Structure structure);
/// Returns the description of an actor's body, moving with the velocity field unless it is static.
BodyDesc make_body_desc(const WorldState& world, const Actor& actor, const Motion& motion);
/// Returns the shape of a convex of an actor; its tag is the slot.
ShapeDesc shape_of(const WorldState& world, const Actor& actor, ConvexSlot slot);
/// Sets the strength of an actor and clears its loads. Kinematic actors do not break.
void set_strength(const WorldState& world, Actor& actor);
/// Returns the volume of a solid within the impact radius of a material, an upper bound.
double reached_m3(const Material& material, double volume_m3);
/// Sets the least energy, impulse and speed of an impact that can break an actor, by pattern or by
/// stress.
void set_least(const WorldState& world, Actor& actor);
/// Counts the limits that an actor with a body of its own is made with: too many bonds for stress
/// by impacts, or too few convexes for stress by contacts.
void count_limits(WorldState& world, const Actor& actor);

/// Sets the motion of an actor's body, or applies an external impulse. Returns the change of its
/// kinetic energy, J.
double move_actor(WorldState& world, const Actor& actor, const BodyState& state);
double push_actor(WorldState& world, const Actor& actor, const Vec3& impulse_W,
                  const Vec3& point_W);

/// Makes an actor's body anew, in its present motion, after its filter or its kind has changed.
void remake_body(WorldState& world, Actor& actor);

void add_compounds(WorldState& world, std::span<const Solid> solids);
/// `structures` are those of the solids' compounds, in their order.
void add_compounds(WorldState& world, std::span<const Solid> solids,
                   std::vector<Structure> structures);
void add_ball(WorldState& world, const Ball& ball);

}  // namespace sunder
