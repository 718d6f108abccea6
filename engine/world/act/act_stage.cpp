#include "engine/world/act/act_stage.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "engine/model/checks/item_check.h"
#include "engine/world/act/moves.h"
#include "engine/world/actors/check_state.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/actors/replace.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

std::uint32_t newest(const WorldState& world) { return world.actors[world.actors.size() - 1].key; }

/// Adds a shot ball on a rope, or on a chain, which is added with it.
void add_hanging_ball(WorldState& world, const Shot& shot) {
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

void shoot(WorldState& world, const Shot& shot, std::uint32_t name) {
  const std::uint32_t first_key = world.actors.next_key();
  if (shot.hangs_from_W) {
    add_hanging_ball(world, shot);
  } else {
    add_ball(world, shot.ball);
  }
  for (Actor& actor : world.actors) {
    if (actor.key < first_key) continue;
    world.log.report.energy.script += kinetic_J(actor, world.physics->state(actor.body));
    actor.name = name;
  }
}

double mass_kg(const WorldState& world, const Shot& shot) {
  double sum_kg = ball_mass_kg(shot.ball, *world.materials);
  for (const Solid& link : shot.links) sum_kg += mass_of(link.compound, *world.materials).mass_kg;
  return sum_kg;
}

void remove_actors(WorldState& world, const std::vector<std::size_t>& gone) {
  std::vector<BodyId> bodies;
  for (const std::size_t i : gone) {
    bodies.push_back(world.actors[i].body);
    world.log.report.joints_lost += world.joints.cut(*world.physics, world.actors[i].key);
  }
  world.physics->replace(bodies, {});
  for (auto i = gone.rbegin(); i != gone.rend(); ++i) world.actors.erase(*i);
}

/// Removes the anchors in a region; their solids stay held by other anchors, or become free.
void remove_anchors(WorldState& world, const Box& region_W) {
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

/// Removes actors by the script or the program.
void take_out(WorldState& world, const std::vector<std::size_t>& gone) {
  for (const std::size_t i : gone) {
    const Actor& actor = world.actors[i];
    world.log.removed_mass_kg += actor.weight.mass_kg;
    world.log.report.energy.script -= kinetic_J(actor, world.physics->state(actor.body));
  }
  remove_actors(world, gone);
}

void remove(WorldState& world, const Removal& removal) {
  if (removal.roots.empty()) {
    remove_anchors(world, removal.anchors_W);
    return;
  }
  std::vector<std::size_t> gone;
  for (std::size_t i = 0; i < world.actors.size(); ++i) {
    if (std::ranges::binary_search(removal.roots, world.actors[i].root_key)) gone.push_back(i);
  }
  take_out(world, gone);
}

/// Turns the smallest fragments at rest into debris if there are more bodies than the limit allows.
void age(WorldState& world) {
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
void set_smallest_piece_factor(WorldState& world) {
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

void apply_drive(WorldState& world, const Drive& drive) {
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

void remove_actor(WorldState& world, std::uint32_t key) {
  take_out(world, {world.actors.place_of(*world.actors.find(key))});
}

void loosen_actor(WorldState& world, std::uint32_t key) {
  Actor& actor = *world.actors.find(key);
  for (const ConvexSlot slot : actor.structure.slots()) actor.structure.loosen(slot);
  BreakEdit nothing_more;
  apply_break(world, key, nothing_more);
}

const char* ActStage::wrong_field(const WorldState& world) const {
  const ItemCheck check("a saved state: ", *world.materials);
  for (const PlannedShot& planned : shots_.to_come()) {
    check.shot(planned.shot, "shots_");
    if (!(planned.mass_kg >= 0)) return "shots_";
    if (planned.name != kNoName && planned.name >= world.names->size()) return "shots_";
  }
  for (const PlannedBlast& planned : blasts_to_come_.to_come())
    check.blast(planned.blast, "blasts_to_come_");
  for (const ActiveBlast& active : blasts_) check.blast(active.blast, "blasts_");
  for (const Drive& drive : drives_) check.drive(drive, "drives_");
  for (const ActorImpact& impact : impacts_)
    if (!is_possible(world, impact)) return "impacts_";
  return nullptr;
}

void ActStage::start(WorldState& world) {
  const Scene& scene = world.scene;
  const std::size_t first_name = scene.solids.size() + scene.balls.size();
  for (std::size_t i = 0; i < scene.shots.size(); ++i) {
    const Shot& shot = scene.shots[i];
    shots_.add(
        {shot.time_s, mass_kg(world, shot), static_cast<std::uint32_t>(first_name + i), shot});
  }
  for (const Blast& blast : scene.blasts) add(blast);
  for (const Removal& removal : scene.removals) add(removal);
  drives_ = scene.drives;
  for (const Move& move : scene.moves)
    for (const std::uint32_t root : move.roots)  // keys are still indices
      moves_.add(world, move, root, scene.solids[root].X_WR);
}

void ActStage::add(WorldState& world, Shot shot) {
  const double kg = mass_kg(world, shot);
  const std::uint32_t name = world.add_name(shot.ball.name);
  shots_.add({shot.time_s, kg, name, std::move(shot)});
}

void ActStage::add(WorldState& world, const Move& move, const Actor& actor) {
  moves_.add(world, move, actor.key, rest_pose(actor, world.physics->state(actor.body).X_WB));
}

void ActStage::add(ActorImpact impact) {
  impact.blast = next_blast_++;
  impacts_.push_back(std::move(impact));
}

std::vector<ActorImpact> ActStage::run(WorldState& world) {
  for (const PlannedShot& due : shots_.take_due(world.clock)) shoot(world, due.shot, due.name);
  for (const Removal& removal : removals_.take_due(world.clock)) remove(world, removal);
  for (PlannedBlast& due : blasts_to_come_.take_due(world.clock)) {
    blasts_.push_back(start_blast(world, std::move(due.blast), due.number));
  }
  std::vector<ActorImpact> impacts = std::exchange(impacts_, {});
  for (ActiveBlast& active : blasts_) {
    for (ActorImpact& impact : find_blast_impacts(world, active)) impacts.push_back(impact);
  }
  moves_.update(world);
  age(world);
  set_smallest_piece_factor(world);
  return impacts;
}

void ActStage::push(WorldState& world) {
  const auto impulse_is_due = [&](const ActiveBlast& active) {
    return world.clock.is_due(active.impulse_time_s);
  };
  for (const ActiveBlast& active : blasts_) {
    if (impulse_is_due(active)) apply_blast_impulses(world, active.blast);
  }
  std::erase_if(blasts_, impulse_is_due);
  std::erase_if(drives_, [&](const Drive& drive) { return world.clock.is_due(drive.until_s); });
  for (const Drive& drive : drives_)
    if (world.clock.is_due(drive.time_s)) apply_drive(world, drive);
}

double ActStage::mass_to_come_kg() const {
  double mass_kg = 0;
  for (const PlannedShot& planned : shots_.to_come()) mass_kg += planned.mass_kg;
  return mass_kg;
}

}  // namespace sunder
