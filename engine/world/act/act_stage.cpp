#include "engine/world/act/act_stage.h"

#include <algorithm>
#include <optional>

#include "engine/world/act/moves.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/actors/replace.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Returns the actions that have become due since the last step.
template <class Act>
std::span<const Act> take_due(const Clock& clock, const std::vector<Act>& acts, std::size_t& next) {
  const std::size_t first = next;
  while (next < acts.size() && clock.is_due(acts[next].time_s)) ++next;
  return std::span(acts).subspan(first, next - first);
}

std::uint32_t newest(const World& world) { return world.actors[world.actors.size() - 1].key; }

/// Adds a shot ball on a rope, or on a chain, which is added with it.
void add_hanging_ball(World& world, const Shot& shot) {
  std::optional<std::uint32_t> above;
  Joint joint;
  if (shot.links.empty()) {
    add_ball(world, shot.ball);
    joint.kind = JointDesc::Kind::kRope;
    joint.at_W = *shot.hangs_from_W;
    joint.to_W = shot.ball.center_W;
  } else {
    const Vec3 way = shot.ball.center_W - *shot.hangs_from_W;
    const Vec3 chain = way - shot.ball.radius_m * way.normalized();
    const double count = static_cast<double>(shot.links.size());
    for (std::size_t i = 0; i < shot.links.size(); ++i) {
      add_compounds(world, std::span(&shot.links[i], 1));
      joint.a = above;
      joint.b = above = newest(world);
      joint.at_W = *shot.hangs_from_W + static_cast<double>(i) / count * chain;
      world.joints.add(*world.physics, world.actors, joint);
    }
    add_ball(world, shot.ball);
    joint.at_W = *shot.hangs_from_W + chain;
  }
  joint.a = above;
  joint.b = newest(world);
  world.joints.add(*world.physics, world.actors, joint);
}

void shoot(World& world, const Shot& shot) {
  const std::uint32_t first_key = world.actors.next_key();
  if (shot.hangs_from_W) {
    add_hanging_ball(world, shot);
  } else {
    add_ball(world, shot.ball);
  }
  const Scene& scene = world.scene;
  const auto number = static_cast<std::size_t>(&shot - scene.shots.data());
  for (Actor& actor : world.actors) {
    if (actor.key < first_key) continue;
    world.log.report.energy.script += kinetic_J(actor, world.physics->state(actor.body));
    actor.name = static_cast<std::uint32_t>(scene.solids.size() + scene.balls.size() + number);
  }
}

void remove_actors(World& world, const std::vector<std::size_t>& gone) {
  std::vector<BodyId> bodies;
  for (const std::size_t i : gone) {
    bodies.push_back(world.actors[i].body);
    world.log.report.joints_lost += world.joints.cut(*world.physics, world.actors[i].key);
  }
  world.physics->replace(bodies, {});
  for (auto i = gone.rbegin(); i != gone.rend(); ++i) world.actors.erase(*i);
}

/// Removes the anchors in a region; their solids stay held by other anchors, or become free.
void remove_anchors(World& world, const Box& region_W) {
  const BodyStates states = world.physics->states();
  std::vector<std::uint32_t> loosened;
  for (Actor& actor : world.actors) {
    if (!actor.is_static) continue;
    const Pose X_WB = states[actor.body].X_WB;
    std::vector<ConvexSlot> slots;
    actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
      const Vec3 at_W = X_WB * (convex.solid.centroid - actor.weight.com_R);
      const bool inside = (at_W.array() >= region_W.min.array()).all() &&
                          (at_W.array() <= region_W.max.array()).all();
      if (inside && actor.structure.anchored(slot) != 0) slots.push_back(slot);
    });
    for (const ConvexSlot slot : slots) actor.structure.loosen(slot);
    if (!slots.empty()) loosened.push_back(actor.key);
  }
  for (const std::uint32_t key : loosened) {
    BreakEdit nothing_more;
    apply_break(world, key, nothing_more);
  }
}

void remove(World& world, const Removal& removal) {
  if (removal.roots.empty()) {
    remove_anchors(world, removal.anchors_W);
    return;
  }
  std::vector<std::size_t> gone;
  for (std::size_t i = 0; i < world.actors.size(); ++i) {
    if (std::ranges::binary_search(removal.roots, world.actors[i].root_key)) gone.push_back(i);
  }
  for (const std::size_t i : gone) {
    const Actor& actor = world.actors[i];
    world.log.removed_mass_kg += actor.weight.mass_kg;
    world.log.report.energy.script -= kinetic_J(actor, world.physics->state(actor.body));
  }
  remove_actors(world, gone);
}

/// Turns the smallest fragments at rest into debris if there are more bodies than the limit allows.
void age(World& world) {
  const Limits& limits = world.scene.limits;
  const std::uint32_t most =
      limits.ageing > 0 ? std::min(limits.ageing, limits.bodies) : limits.bodies;
  if (world.actors.size() <= most - most / kBodyReserve) return;
  const BodyStates states = world.physics->states();
  std::vector<std::size_t> resting;
  for (std::size_t i = 0; i < world.actors.size(); ++i) {
    const Actor& actor = world.actors[i];
    const bool fragment = actor.key != actor.root_key && !actor.structure.empty();
    if (fragment && !actor.is_static && states[actor.body].asleep) resting.push_back(i);
  }
  // Ascending by key already: equal volumes have a stable order.
  std::ranges::stable_sort(resting, {}, [&](std::size_t i) { return world.actors[i].volume_m3; });
  // Removes more than needed, so that not every step has to.
  const std::size_t wanted = world.actors.size() - (most - 2 * (most / kBodyReserve));
  resting.resize(std::min(resting.size(), wanted));
  std::ranges::sort(resting);
  for (const std::size_t i : resting) {
    const Actor& actor = world.actors[i];
    note_chip(world, actor.structure.compound(), motion_of(actor, states[actor.body]));
    world.log.debris_mass_kg += actor.weight.mass_kg;
    ++world.log.report.aged;
  }
  if (!resting.empty()) remove_actors(world, resting);
}

/// Sets the factor on the volume of the smallest pieces for this step.
void set_smallest_piece_factor(World& world) {
  const std::uint32_t full_detail = world.scene.limits.full_detail;
  if (full_detail == 0) return;
  const BodyStates states = world.physics->states();
  const auto awake = std::ranges::count_if(world.actors, [&](const Actor& actor) {
    return !actor.is_static && !states[actor.body].asleep;
  });
  world.smallest_piece_factor = std::max(1.0, static_cast<double>(awake) / full_detail);
}

Vec3 limit_length(double most, const Vec3& impulse) {
  return impulse.norm() > most ? Vec3(impulse * (most / impulse.norm())) : impulse;
}

void apply_drive(World& world, const Drive& drive) {
  const double dt_s = world.clock.dt_s;
  for (const std::uint32_t root : drive.roots) {
    const Actor* actor = world.actors.find(root);
    if (!actor || actor->is_static) continue;
    const BodyState state = world.physics->state(actor->body);
    const auto push = [&](const Vec3& impulse, const Vec3& arm) {
      world.log.report.energy.drives +=
          push_actor(world, *actor, impulse, state.X_WB.position + arm);
    };
    if (drive.velocity_W) {
      const Vec3 missing = *drive.velocity_W - state.velocity_W;
      const Vec3 impulse = limit_length(drive.force_N * dt_s, actor->weight.mass_kg * missing);
      if (impulse.norm() > 0) push(impulse, Vec3::Zero());
    }
    if (drive.angular_velocity_W) {
      const Quat& q = state.X_WB.rotation;
      const Vec3 missing = *drive.angular_velocity_W - state.angular_velocity_W;
      const Vec3 turn = limit_length(drive.torque_Nm * dt_s,
                                     q * (actor->weight.inertia_R * (q.conjugate() * missing)));
      if (!(turn.norm() > 0)) continue;
      const Vec3 arm = turn.unitOrthogonal();  // a couple: two opposite impulses 1 m apart
      push(turn.cross(arm), 0.5 * arm);
      push(-turn.cross(arm), -0.5 * arm);
    }
  }
}

}  // namespace

std::vector<ActorImpact> ActStage::run(World& world) {
  for (const Shot& shot : take_due(world.clock, world.scene.shots, next_shot_)) shoot(world, shot);
  for (const Removal& removal : take_due(world.clock, world.scene.removals, next_removal_)) {
    remove(world, removal);
  }
  for (const Blast& blast : take_due(world.clock, world.scene.blasts, next_blast_)) {
    blasts_.push_back(start_blast(world, blast));
  }
  std::vector<ActorImpact> impacts;
  for (ActiveBlast& active : blasts_) {
    for (ActorImpact& impact : find_blast_impacts(world, active)) impacts.push_back(impact);
  }
  update_moves(world);
  age(world);
  set_smallest_piece_factor(world);
  return impacts;
}

void ActStage::push(World& world) {
  const auto impulse_is_due = [&](const ActiveBlast& active) {
    return world.clock.is_due(active.impulse_time_s);
  };
  for (const ActiveBlast& active : blasts_) {
    if (impulse_is_due(active)) apply_blast_impulses(world, active.blast);
  }
  std::erase_if(blasts_, impulse_is_due);
  for (const Drive& drive : world.scene.drives) {
    const bool on = world.clock.is_due(drive.time_s) && !world.clock.is_due(drive.until_s);
    if (on) apply_drive(world, drive);
  }
}

std::span<const Shot> ActStage::shots_to_come(const Scene& scene) const {
  return std::span(scene.shots).subspan(next_shot_);
}

}  // namespace sunder
