#include "engine/world/load/load_stage.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/roots.h"
#include "engine/base/trace.h"
#include "engine/model/work_log.h"
#include "engine/world/actors/load_case.h"
#include "engine/world/actors/replace.h"
#include "engine/world/load/rejoin.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

constexpr std::size_t kLargeConvexes = 1000;  // convexes of an actor that is solved by all threads
constexpr std::size_t kActorsPerChunk = 256;  // visited by one thread
constexpr ConvexSlot kPastLastSlot;           // none(), greater than any slot

bool is_large(const Actor& actor) { return actor.structure.size() >= kLargeConvexes; }

double weight_N(const WorldState& world, double mass_kg) {
  return mass_kg * world.scene.gravity_W.norm();
}

/// Force on a convex of the actor at an index in WorldState::actors.
struct ActorForce {
  std::size_t place = 0;
  AppliedForce force;
};

/// Returns the mean forces on an actor after one more step with the forces `now`.
std::vector<AppliedForce> averaged(const WorldState& world, const Actor& actor,
                                   std::span<const ActorForce> now) {
  if (now.empty() && actor.stress.mean_forces.empty()) return {};
  const double dt = world.clock.dt_s, share = dt / (kForceAveragingTime_s + dt);
  const double negligible = kNegligibleLoad * weight_N(world, actor.weight.mass_kg);
  const double size_m = cube_root(actor.volume_m3);
  std::vector<AppliedForce> mean;
  auto old = actor.stress.mean_forces.begin();
  const auto end = actor.stress.mean_forces.end();
  for (auto it = now.begin(); it != now.end() || old != end;) {
    AppliedForce force;
    force.convex = std::min(it != now.end() ? it->force.convex : kPastLastSlot,
                            old != end ? old->convex : kPastLastSlot);
    if (old != end && old->convex == force.convex) {
      force.force_N += (1 - share) * old->force_N;
      force.torque_Nm += (1 - share) * old->torque_Nm;
      ++old;
    }
    for (; it != now.end() && it->force.convex == force.convex; ++it) {
      force.force_N += share * it->force.force_N;
      force.torque_Nm += share * it->force.torque_Nm;
    }
    if (force.force_N.norm() > kNegligibleMeanForce * negligible ||
        force.torque_Nm.norm() > kNegligibleMeanForce * negligible * size_m)
      mean.push_back(force);
  }
  return mean;
}

/// Returns true if the mean forces differ from those of the last stress solve.
bool load_changed(const WorldState& world, const Actor& actor) {
  const double negligible = kNegligibleLoad * weight_N(world, actor.weight.mass_kg);
  const std::vector<AppliedForce>&x = actor.stress.evaluated_forces, &y = actor.stress.mean_forces;
  for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
    const ConvexSlot convex = std::min(i < x.size() ? x[i].convex : kPastLastSlot,
                                       j < y.size() ? y[j].convex : kPastLastSlot);
    AppliedForce before, after;
    if (i < x.size() && x[i].convex == convex) before = x[i++];
    if (j < y.size() && y[j].convex == convex) after = y[j++];
    const Convex& body = *actor.structure.convex(convex);
    const double density = world.material(body.material).density_kg_m3;
    const double self_weight = weight_N(world, density * body.solid.volume_m3);
    const double allowed =
        std::max(negligible, kMinLoadChange * (self_weight + before.force_N.norm()));
    if ((after.force_N - before.force_N).norm() > allowed) return true;
    const double arm = body.box.extent().maxCoeff();
    if ((after.torque_Nm - before.torque_Nm).norm() > allowed * arm) return true;
  }
  return false;
}

/// Returns the spin of an actor, or 0 if it is negligible.
Vec3 relevant_spin(const Actor& actor, const BodyState& state) {
  const Vec3& spin_W = state.angular_velocity_W;
  if (!(spin_W.squaredNorm() > kNegligibleSpin * actor.stress.burst_omega2_s2)) return Vec3::Zero();
  return state.X_WB.rotation.conjugate() * spin_W;
}

/// Returns true if the spin differs from that of the last stress solve; the load ω × (ω × r) is
/// equal for opposite spins.
bool spin_changed(const StressState& stress) {
  const Vec3 &before = stress.evaluated_spin_R, &after = stress.spin_R;
  const double allowed =
      std::max(kMinLoadChange * before.squaredNorm(), kNegligibleSpin * stress.burst_omega2_s2);
  return (after - before).norm() * (after + before).norm() > allowed;
}

/// Returns the forces of contacts and joints on actors in this step, in the order of actors, then
/// convexes; forces are in the rest frame, torques about the convex's centroid.
std::vector<ActorForce> find_forces(const WorldState& world) {
  std::vector<ActorForce> all;
  const BodyStates states = world.physics->states();
  const double dt = world.clock.dt_s;
  const auto point_R = [&](const Actor& actor, const Vec3& point_W) -> Vec3 {
    return states[actor.body].X_WB.inverse() * point_W + actor.weight.com_R;
  };
  const auto add = [&](const Actor& actor, const AppliedForce& load) {
    const Vec3 arm = load.point_R - actor.structure.convex(load.convex)->solid.centroid;
    all.push_back(
        {world.actors.place_of(actor),
         {load.convex, load.force_N, Vec3::Zero(), arm.cross(load.force_N) + load.torque_Nm}});
  };
  for (const ContactImpulse& contact : world.physics->contact_impulses()) {
    const Actor* actor = world.actors.find(contact.body_tag);
    const ConvexSlot slot(contact.shape_tag);
    if (!actor || !actor->structure.has(slot)) continue;
    const Quat rotation_BW = states[actor->body].X_WB.rotation.conjugate();
    add(*actor, {slot, rotation_BW * contact.impulse_W / dt, point_R(*actor, contact.point_W)});
  }
  std::vector<AppliedForce> pulls;
  for (const JointImpulse& joint : world.physics->joint_impulses()) {
    const Actor* actor = world.actors.find(joint.body_tag);
    if (!actor || actor->structure.empty()) continue;
    const Quat rotation_BW = states[actor->body].X_WB.rotation.conjugate();
    pulls.clear();
    add_joint_load(actor->structure, point_R(*actor, joint.point_W),
                   rotation_BW * joint.impulse_W / dt, rotation_BW * joint.angular_impulse_W / dt,
                   pulls);
    for (const AppliedForce& pull : pulls) add(*actor, pull);
  }
  std::stable_sort(all.begin(), all.end(), [](const ActorForce& x, const ActorForce& y) {
    return std::tie(x.place, x.force.convex) < std::tie(y.place, y.force.convex);
  });
  return all;
}

/// Updates the mean forces of all actors; returns the keys of those to be solved, the longest
/// deferred first.
std::vector<std::uint32_t> update_loads(WorldState& world) {
  const std::vector<ActorForce> now = find_forces(world);
  const BodyStates states = world.physics->states();
  using Due = std::pair<std::uint64_t, std::uint32_t>;
  const auto visit = [&](std::size_t begin, std::size_t end, std::vector<Due>& found) {
    auto first = std::ranges::lower_bound(now, begin, {}, &ActorForce::place);
    for (std::size_t i = begin; i < end; ++i) {
      const auto last =
          std::find_if(first, now.end(), [i](const ActorForce& on) { return on.place > i; });
      const std::span<const ActorForce> on_actor(first, last);
      first = last;
      Actor& actor = world.actors[i];
      StressState& stress = actor.stress;
      if (!stress.breakable) continue;
      stress.mean_forces = averaged(world, actor, on_actor);
      stress.spin_R = relevant_spin(actor, states[actor.body]);
      // In free fall, only spin causes stress.
      if (!actor.is_static && stress.mean_forces.empty() && stress.spin_R.isZero()) continue;
      if (stress.settled && (load_changed(world, actor) || spin_changed(stress))) {
        stress.settled = false;
        stress.since_step = world.clock.step;
      }
      if (!stress.settled) found.emplace_back(stress.since_step, actor.key);
    }
  };
  auto due = collect_chunks<Due>(world.actors.size(), kActorsPerChunk, visit);
  std::sort(due.begin(), due.end());
  std::vector<std::uint32_t> keys;
  for (const auto& [since, key] : due) keys.push_back(key);
  return keys;
}

std::vector<std::uint32_t> find_due(WorldState& world) {
  WorkSpan span(world.log.work_counts, Stage::kLoad, "solids due");
  std::vector<std::uint32_t> keys = update_loads(world);
  span.count(keys.size());
  return keys;
}

StressResult find_stress(const WorldState& world, const Breaker& breaker, const Actor& actor,
                         const Quat& rotation_WB, std::uint64_t most_work) {
  std::vector<AppliedForce> loads;
  LoadCase load = make_load_case(world, actor, rotation_WB, loads);
  load.most_work = most_work;
  return breaker.stress(actor.structure, load);
}

struct StressTask {
  std::uint32_t key = 0;
  std::uint64_t most_work = 0;
  StressResult answer;
  double ms = 0;
};

/// Solves the stress of all actors of a batch, each within its reserved work.
void find_stresses(const WorldState& world, const Breaker& breaker,
                   std::vector<StressTask>& batch) {
  const BodyStates states = world.physics->states();
  const auto one = [&](StressTask& task) {
    const Stopwatch watch;
    const Actor& actor = *world.actors.find(task.key);
    task.answer =
        find_stress(world, breaker, actor, states[actor.body].X_WB.rotation, task.most_work);
    task.ms = watch.ms();
  };
  const auto large = [&](const StressTask& task) { return is_large(*world.actors.find(task.key)); };
  for_chunks(batch.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    if (!large(batch[i])) one(batch[i]);
  });
  for (StressTask& task : batch) {
    if (large(task)) one(task);
  }
}

/// Applies the result of a stress solve to its actor.
void apply(WorldState& world, StressTask& task) {
  Actor& actor = *world.actors.find(task.key);
  StressResult& answer = task.answer;
  actor.stress.evaluated_forces = actor.stress.mean_forces;
  actor.stress.evaluated_spin_R = actor.stress.spin_R;
  actor.stress.memory = answer.memory;
  actor.stress.settled = answer.settled;
  actor.stress.since_step = world.clock.step;
  if (answer.gave_up) ++world.log.report.limits[Limit::kLoadIterations];
  BreakEdit& edit = answer.edit;
  if (!edit.changed) {
    actor.structure.apply(edit);
    return;
  }
  if (!fits_body_limit(world, edit)) {
    ++world.log.report.limits[Limit::kBodies];
    actor.stress.settled = true;
    return;
  }
  const Pose X_WB = world.physics->state(actor.body).X_WB;
  Vec3 middle_R = actor.weight.com_R;
  MaterialIndex material = actor.materials[0];
  if (!edit.loose.exposed.empty()) {
    const Convex& broken = edit.exposed_convex(actor.structure, edit.loose.exposed[0]);
    middle_R = broken.solid.centroid;
    material = broken.material;
  }
  BreakEvent event = make_break_event(world, actor, material);
  event.point_W = X_WB * Vec3(middle_R - actor.weight.com_R);
  event.new_area_m2 = edit.loose.new_area_m2;
  event.plan_ms = task.ms;
  event.pieces = pieces_after(actor.structure, edit);
  const bool only_bends = !edit.hinges.empty() && edit.cut.empty();
  const bool opens_overlap = edit.loose.pieces.empty();
  event.child_keys = apply_break(world, task.key, edit);
  if (!only_bends && !opens_overlap) world.log.breaks.push_back(std::move(event));
}

}  // namespace

void LoadStage::prepare(WorldState& world, const Breaker& breaker) const {
  std::vector<StressTask> batch;
  for (const Actor& actor : world.actors) {
    if (actor.stress.breakable && is_large(actor)) batch.push_back({actor.key, 0, {}, 0});
  }
  find_stresses(world, breaker, batch);
  for (StressTask& task : batch) {
    world.actors.find(task.key)->stress.memory = std::move(task.answer.memory);
  }
}

void LoadStage::begin_frame(double share) {
  const std::int64_t work = std::llround(share * static_cast<double>(work_a_frame_));
  work_left_ = std::min(kMaxSavedFrames * work_a_frame_, work_left_ + work);
}

void LoadStage::run(WorldState& world, const Breaker& breaker) {
  const bool any = std::any_of(world.actors.begin(), world.actors.end(),
                               [](const Actor& actor) { return actor.stress.breakable; });
  deferred_ = 0;
  if (!any) return;
  const std::vector<std::uint32_t> keys = find_due(world);
  std::size_t next = 0;
  while (next < keys.size() && work_left_ > 0) {
    std::vector<StressTask> batch;
    auto left = static_cast<std::uint64_t>(work_left_);
    for (; next < keys.size() && left > 0; ++next) {
      const std::uint64_t bonds = world.actors.find(keys[next])->structure.bond_count();
      const std::uint64_t reserved = std::min(left, kReservedEvaluationsPerBond * (bonds + 1));
      batch.push_back({keys[next], reserved, {}, 0});
      left -= reserved;
    }
    WorkSpan span(world.log.work_counts, Stage::kLoad, "solids judged");
    span.count(batch.size());
    find_stresses(world, breaker, batch);
    for (StressTask& task : batch) {
      work_left_ -= static_cast<std::int64_t>(task.answer.work);
      world.log.work_counts.add({Stage::kLoad, "bonds visited", task.answer.work});
      apply(world, task);
    }
  }
  deferred_ = static_cast<std::uint32_t>(keys.size() - next);
  if (work_left_ > 0) work_left_ -= static_cast<std::int64_t>(rejoin(world, breaker));
}

}  // namespace sunder
