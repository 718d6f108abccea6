#include "engine/world/act/moves.h"

#include "engine/base/rotation.h"
#include "engine/world/actors/make_actor.h"

namespace sunder {
namespace {

/// Makes an actor kinematic or free, with its current motion.
void set_kinematic(World& world, Actor& actor, bool is_kinematic) {
  const BodyState was = world.physics->state(actor.body);
  const Motion motion = motion_of(actor, was);
  const double before_J = kinetic_J(actor, was);
  actor.is_static = actor.is_kinematic = is_kinematic;
  set_strength(world, actor);
  const BodyDesc body = make_body_desc(world, actor, motion);
  actor.body = world.physics->replace(std::span(&actor.body, 1), std::span(&body, 1))[0];
  world.log.report.energy.script += kinetic_J(actor, world.physics->state(actor.body)) - before_J;
  world.joints.reattach(*world.physics, actor);
}

Pose pose_at(const Move& move, const Pose& start, double time_s) {
  const PathKey key = move.path.at(time_s);
  const Vec3 pivot_W = move.pivot_W.value_or(start.position);
  const Quat turn = rotation_by(key.rotation_W);
  return {pivot_W + key.shift_W + turn * (start.position - pivot_W), turn * start.rotation};
}

void update_moves(World& world, const Move& move, Actor& actor) {
  const double dt_s = world.clock.dt_s, now_s = world.clock.time_s();
  const Pose& start = world.scene.solids[actor.root_key].X_WR;
  const Pose from = pose_at(move, start, now_s), to = pose_at(move, start, now_s + dt_s);
  BodyState state;
  state.X_WB = {from * actor.weight.com_R, from.rotation};
  state.velocity_W = (to * actor.weight.com_R - state.X_WB.position) / dt_s;
  state.angular_velocity_W = rotation_vector(to.rotation * from.rotation.conjugate()) / dt_s;
  const auto stands = [](const BodyState& s) {
    return s.velocity_W.isZero(0) && s.angular_velocity_W.isZero(0);
  };
  if (stands(state) && stands(world.physics->state(actor.body))) return;
  world.physics->set_state(actor.body, state);
}

}  // namespace

void start_moves(World& world) {
  for (const Move& move : world.scene.moves) {
    for (const std::uint32_t root : move.roots)
      set_kinematic(world, *world.actors.find(root), true);
  }
}

void update_moves(World& world) {
  for (const Move& move : world.scene.moves) {
    for (const std::uint32_t root : move.roots) {
      Actor* actor = world.actors.find(root);
      if (!actor || !actor->is_kinematic) continue;  // removed or released
      if (world.clock.is_due(move.release_s)) {
        set_kinematic(world, *actor, false);
      } else {
        update_moves(world, move, *actor);
      }
    }
  }
}

}  // namespace sunder
