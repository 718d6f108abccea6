// Actors come and go: bodies for the physics, meshes for the eye. Internal to engine/world.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "engine/world/actors/world.h"

namespace sunder {

/// A rigid velocity field, and where the rest frame is.
struct Motion {
  Pose X_WR;
  Vec3 point_W = Vec3::Zero();  ///< Where `velocity_W` is measured.
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
};

/// How a convex is drawn.
struct Drawn {
  MeshIndex mesh;  ///< none() where nothing shows.
  std::vector<std::uint8_t> hidden;
};
using DrawnBefore = std::unordered_map<const Convex*, Drawn>;

/// An actor with a new key and no body yet; anchored compounds become static.
Actor make_actor(World& world, const Compound& compound);
/// Its body, moving with the field (static bodies do not move).
BodyDesc describe(const World& world, const Actor& actor, const Motion& motion);
/// The shape of one of its convexes.
ShapeDesc shape_of(const World& world, const Actor& actor, std::uint32_t slot);
/// The least energy and impulse that could break it.
void set_least(const World& world, Actor& actor);
/// Gives new actors their meshes; convexes that look as they did in `old` keep theirs. What is new
/// is drawn when somebody looks: by draw(), before a snapshot.
void add_meshes(World& world, std::span<Actor> actors, const DrawnBefore& old);
/// Draws convexes of an actor anew whose faces are hidden otherwise than before; slots may be new.
void renew_meshes(World& world, Actor& actor, std::span<const std::uint32_t> slots);
/// Makes the meshes that are still missing.
void draw(World& world);

void add_compounds(World& world, std::span<const Solid> solids);
/// Notes what a break laid bare, for the particles, once it is carried out: `edit` was applied to
/// `structure`, and its pieces are the actors with these keys (kNobodyKey: too small for one).
void crumble(World& world, const Structure& structure, const BreakEdit& edit, const Motion& before,
             std::span<const std::uint32_t> piece_keys);
/// Notes a piece that is too small to be a body.
void add_chip(World& world, const Compound& piece, const Motion& motion);

double ball_mass_kg(const World& world, const Ball& ball);
void add_ball(World& world, const Ball& ball);

}  // namespace sunder
