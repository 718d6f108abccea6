#include "engine/world/replace.h"

#include <iterator>
#include <utility>

#include "engine/world/actors.h"
#include "engine/world/ties.h"

namespace sunder {
namespace {

Vec3 momentum_of(const World& world, std::span<const Actor> actors) {
  Vec3 sum = Vec3::Zero();
  for (const Actor& actor : actors) {
    if (!actor.is_static) sum += actor.weight.mass_kg * world.physics->state(actor.body).velocity_W;
  }
  return sum;
}

/// Whether a piece is a body: held in place, or large enough.
bool is_body(const World& world, const Compound& piece) {
  if (piece.is_anchored()) return true;
  return volume(piece) >= world.material(piece.convexes[0]->material).smallest_piece_m3;
}

/// Momentum of what the pieces leave of the parent: debris flies on with the parent's motion.
Vec3 debris_momentum(const Actor& parent, std::span<const Actor> pieces, const Motion& motion) {
  double mass = parent.weight.mass_kg;
  Vec3 moment_R = Vec3::Zero();
  for (const Actor& piece : pieces) {
    mass -= piece.weight.mass_kg;
    moment_R -= piece.weight.mass_kg * (piece.weight.com_R - parent.weight.com_R);
  }
  return mass * motion.velocity_W +
         motion.angular_velocity_W.cross(motion.X_WR.rotation * moment_R);
}

}  // namespace

bool has_room(World& world, const BreakPlan& plan) {
  if (world.actors.size() + plan.pieces.size() <= world.scene.limits.bodies) return true;
  ++world.report.limits_hit;
  return false;
}

void replace_by_pieces(World& world, std::uint32_t key, BreakPlan& plan) {
  const std::size_t at = static_cast<std::size_t>(world.find(key) - world.actors.data());
  Actor& parent = world.actors[at];
  const BodyState state = world.physics->state(parent.body);
  const Pose X_WR{state.X_WB * Vec3(-parent.weight.com_R), state.X_WB.rotation};
  const Motion motion{X_WR, state.X_WB.position, state.velocity_W, state.angular_velocity_W};
  std::vector<Actor> pieces;
  std::vector<BodyDesc> bodies;
  world.debris_mass_kg += parent.weight.mass_kg;
  crumble(world, plan, motion);
  for (Compound& compound : plan.pieces) {
    if (!is_body(world, compound)) {
      add_chip(world, compound, motion);
      continue;
    }
    pieces.push_back(make_actor(world, std::move(compound)));
    pieces.back().born_step = world.step + 1;
    pieces.back().root_key = parent.root_key;
    if (pieces.back().bearing.bears) pieces.back().bearing.memory = parent.bearing.memory;
    world.debris_mass_kg -= pieces.back().weight.mass_kg;
    bodies.push_back(describe(world, pieces.back(), motion));
  }
  add_meshes(world, pieces, &parent);
  const Vec3 before = momentum_of(world, std::span(&parent, 1));
  const std::vector<BodyId> ids = world.physics->replace(std::span(&parent.body, 1), bodies);
  for (std::size_t i = 0; i < pieces.size(); ++i) pieces[i].body = ids[i];
  move_ties(world, key, pieces);
  if (!parent.is_static) {
    const Vec3 after = momentum_of(world, pieces) + debris_momentum(parent, pieces, motion);
    world.momentum_error_Ns += (after - before).norm();
  }
  world.actors.erase(world.actors.begin() + static_cast<std::ptrdiff_t>(at));
  std::move(pieces.begin(), pieces.end(), std::back_inserter(world.actors));
}

}  // namespace sunder
