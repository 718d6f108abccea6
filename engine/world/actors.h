// Actors come and go: bodies for the physics, meshes for the eye. Internal to engine/world.
#pragma once

#include <span>

#include "engine/world/world.h"

namespace sunder {

/// A rigid velocity field, and where the rest frame is.
struct Motion {
  Pose X_WR;
  Vec3 point_W = Vec3::Zero();  ///< Where `velocity_W` is measured.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
};

/// An actor with a new key and no body yet; anchored compounds become static.
Actor make_actor(World& world, Compound compound);
/// Its body, moving with the field (static bodies do not move).
BodyDesc describe(const World& world, const Actor& actor, const Motion& motion);
/// Gives new actors their meshes; convexes that look as they did in `parent` keep theirs.
void add_meshes(World& world, std::span<Actor> actors, const Actor* parent);

void add_compounds(World& world, std::span<const Solid> solids);
/// Notes what a break laid bare, for the particles; before its pieces are moved elsewhere.
void crumble(World& world, const BreakPlan& plan, const Motion& motion);
/// Notes a piece that is too small to be a body.
void add_chip(World& world, const Compound& piece, const Motion& motion);

double ball_mass_kg(const World& world, const Ball& ball);
void add_ball(World& world, const Ball& ball);

}  // namespace sunder
