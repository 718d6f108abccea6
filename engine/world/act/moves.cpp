#include "engine/world/act/moves.h"

#include <cmath>

#include "engine/base/rotation.h"
#include "engine/world/actors/make_actor.h"

namespace sunder {
namespace {

Pose pose_at(const PathKey& key, const Vec3& pivot_W, const Pose& start) {
  const Quat turn = rotation_by(key.rotation_W);
  return {pivot_W + key.shift_W + turn * (start.position - pivot_W), turn * start.rotation};
}

}  // namespace

void set_kinematic(WorldState& world, Actor& actor, bool is_kinematic) {
  if (actor.is_kinematic == is_kinematic) return;
  const double before_J = kinetic_J(actor, world.physics->state(actor.body));
  actor.is_static = actor.is_kinematic = is_kinematic;
  set_strength(world, actor);
  remake_body(world, actor);
  world.log.report.energy.script += kinetic_J(actor, world.physics->state(actor.body)) - before_J;
}

void Moves::add(WorldState& world, const Move& move, std::uint32_t key, const Pose& start_X_WR) {
  set_kinematic(world, *world.actors.find(key), true);
  end(key);
  active_.push_back({key, start_X_WR, world.clock.time_s(), move.path,
                     move.pivot_W.value_or(start_X_WR.position), move.release_s});
}

const char* Moves::wrong_field() const {
  for (const Active& move : active_) {
    if (!std::isfinite(move.start_s)) return "active_";
    double last_s = 0;
    for (const PathKey& key : move.path.keys) {
      if (!(key.time_s > last_s)) return "active_";
      last_s = key.time_s;
    }
  }
  return nullptr;
}

void Moves::end(std::uint32_t key) {
  std::erase_if(active_, [&](const Active& move) { return move.key == key; });
}

void Moves::update(WorldState& world, const Active& move, Actor& actor) const {
  const double dt_s = world.clock.dt_s, now_s = world.clock.time_s() - move.start_s;
  const Pose from = pose_at(move.path.at(now_s), move.pivot_W, move.start_X_WR);
  const Pose to = pose_at(move.path.at(now_s + dt_s), move.pivot_W, move.start_X_WR);
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

void Moves::update(WorldState& world) {
  std::erase_if(active_, [&](const Active& move) {
    Actor* actor = world.actors.find(move.key);
    if (!actor || !actor->is_kinematic) return true;  // removed or released
    if (world.clock.is_due(move.release_s)) {
      set_kinematic(world, *actor, false);
      return true;
    }
    update(world, move, *actor);
    return false;
  });
}

}  // namespace sunder
