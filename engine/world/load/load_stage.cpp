#include "engine/world/load/load_stage.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/trace.h"
#include "engine/model/work_log.h"
#include "engine/world/actors/bearing.h"
#include "engine/world/actors/replace.h"
#include "engine/world/load/rejoin.h"

namespace sunder {
namespace {

constexpr double kAverage_s = 0.1;  // over which what presses is averaged
// Load on a convex has changed if by this share of what it bears, its own weight counted, ...
constexpr double kChange = 0.1;
// ... unless that is less than this share of the whole actor's weight.
constexpr double kTrifle = 1e-5;
// Spin matters from so much of ρ ω² r² on, in parts of the weakest limit; the largest stress is
// half of that in a rod, all of it in a ring, and more only where spin bends what is hollow or
// crooked.
constexpr double kSpinTrifle = 0.03;
// Work to reserve for an actor, in visits of each of its bonds; what is left over goes to others.
constexpr std::uint64_t kReserve = 30;
constexpr std::int64_t kSavedFrames = 2;  // whose work a frame may have, those that spent less
constexpr std::size_t kLarge = 1000;      // convexes of an actor that takes all threads for itself
constexpr std::size_t kActors = 256;      // looked at by one thread
constexpr ConvexSlot kAfterAll;           // none() is greater than any slot

bool is_large(const Actor& actor) { return actor.structure.size() >= kLarge; }

double weight_N(const World& world, double mass_kg) {
  return mass_kg * world.scene.gravity_W.norm();
}

/// What presses on a convex of the actor at this place in World::actors.
struct PressOn {
  std::size_t place = 0;
  Press press;
};

/// The mean of what presses on the actor, moved on by one step in which `now` pressed.
std::vector<Press> averaged(const World& world, const Actor& actor, std::span<const PressOn> now) {
  if (now.empty() && actor.stress.pressing.empty()) return {};
  const double dt = world.clock.dt_s, share = dt / (kAverage_s + dt);
  const double trifle = kTrifle * weight_N(world, actor.weight.mass_kg);
  const double size_m = std::cbrt(actor.volume_m3);
  std::vector<Press> mean;
  auto old = actor.stress.pressing.begin();
  const auto end = actor.stress.pressing.end();
  for (auto it = now.begin(); it != now.end() || old != end;) {
    Press press;
    press.convex = std::min(it != now.end() ? it->press.convex : kAfterAll,
                            old != end ? old->convex : kAfterAll);
    if (old != end && old->convex == press.convex) {
      press.force_R += (1 - share) * old->force_R;
      press.torque_R += (1 - share) * old->torque_R;
      ++old;
    }
    for (; it != now.end() && it->press.convex == press.convex; ++it) {
      press.force_R += share * it->press.force_R;
      press.torque_R += share * it->press.torque_R;
    }
    if (press.force_R.norm() > 0.1 * trifle || press.torque_R.norm() > 0.1 * trifle * size_m)
      mean.push_back(press);
  }
  return mean;
}

/// Whether what presses differs from what the actor was judged by.
bool changed(const World& world, const Actor& actor) {
  const double trifle = kTrifle * weight_N(world, actor.weight.mass_kg);
  const std::vector<Press>&x = actor.stress.judged, &y = actor.stress.pressing;
  for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
    const ConvexSlot convex =
        std::min(i < x.size() ? x[i].convex : kAfterAll, j < y.size() ? y[j].convex : kAfterAll);
    Press before, after;
    if (i < x.size() && x[i].convex == convex) before = x[i++];
    if (j < y.size() && y[j].convex == convex) after = y[j++];
    const Convex& body = *actor.structure.convex(convex);
    const double density = world.material(body.material).density_kg_m3;
    const double own = weight_N(world, density * body.solid.volume_m3);
    const double allowed = std::max(trifle, kChange * (own + before.force_R.norm()));
    if ((after.force_R - before.force_R).norm() > allowed) return true;
    const double arm = body.box.extent().maxCoeff();
    if ((after.torque_R - before.torque_R).norm() > allowed * arm) return true;
  }
  return false;
}

/// What the actor feels of its spin: nothing if that cannot matter.
Vec3 spin_felt(const Actor& actor, const BodyState& state) {
  const Vec3& spin_W = state.angular_velocity_W;
  if (!(spin_W.squaredNorm() > kSpinTrifle * actor.stress.bursts_s2)) return Vec3::Zero();
  return state.X_WB.rotation.conjugate() * spin_W;
}

/// Whether it spins otherwise than it was judged for: what it feels, ω × (ω × r), is the same for
/// the opposite spin.
bool spin_changed(const StressState& stress) {
  const Vec3 &before = stress.judged_spin_R, &after = stress.spin_R;
  const double allowed = std::max(kChange * before.squaredNorm(), kSpinTrifle * stress.bursts_s2);
  return (after - before).norm() * (after + before).norm() > allowed;
}

/// What presses and pulls on actors in this step, by their order and that of convexes; forces are
/// in the rest frame, torques about the convex's centroid.
std::vector<PressOn> presses(const World& world) {
  std::vector<PressOn> all;
  const BodyStates states = world.physics->states();
  const double dt = world.clock.dt_s;
  const auto point_R = [&](const Actor& actor, const Vec3& point_W) -> Vec3 {
    return states[actor.body].X_WB.inverse() * point_W + actor.weight.com_R;
  };
  const auto add = [&](const Actor& actor, const Load& load) {
    const Vec3 arm = load.point_R - actor.structure.convex(load.convex)->solid.centroid;
    all.push_back({world.actors.place_of(actor),
                   {load.convex, load.force_N, arm.cross(load.force_N) + load.torque_Nm}});
  };
  for (const ContactLoad& contact : world.physics->contact_loads()) {
    const Actor* actor = world.actors.find(contact.body_tag);
    const ConvexSlot slot(contact.shape_tag);
    if (!actor || !actor->structure.has(slot)) continue;
    const Quat rotation_BW = states[actor->body].X_WB.rotation.conjugate();
    add(*actor, {slot, rotation_BW * contact.impulse_W / dt, point_R(*actor, contact.point_W)});
  }
  std::vector<Load> pulls;
  for (const JointLoad& joint : world.physics->joint_loads()) {
    const Actor* actor = world.actors.find(joint.body_tag);
    if (!actor || actor->structure.empty()) continue;
    const Quat rotation_BW = states[actor->body].X_WB.rotation.conjugate();
    pulls.clear();
    add_joint_load(actor->structure, point_R(*actor, joint.point_W),
                   rotation_BW * joint.impulse_W / dt, rotation_BW * joint.angular_impulse_W / dt,
                   pulls);
    for (const Load& pull : pulls) add(*actor, pull);
  }
  std::stable_sort(all.begin(), all.end(), [](const PressOn& x, const PressOn& y) {
    return std::tie(x.place, x.press.convex) < std::tie(y.place, y.press.convex);
  });
  return all;
}

/// Takes note of what presses; the keys of those to be judged, the longest waiting first.
std::vector<std::uint32_t> due(World& world) {
  const std::vector<PressOn> now = presses(world);
  const BodyStates states = world.physics->states();
  using Waiting = std::pair<std::uint64_t, std::uint32_t>;
  const auto look = [&](std::size_t begin, std::size_t end, std::vector<Waiting>& found) {
    auto first = std::ranges::lower_bound(now, begin, {}, &PressOn::place);
    for (std::size_t i = begin; i < end; ++i) {
      const auto last =
          std::find_if(first, now.end(), [i](const PressOn& on) { return on.place > i; });
      const std::span<const PressOn> on_it(first, last);
      first = last;
      Actor& actor = world.actors[i];
      StressState& stress = actor.stress;
      if (!stress.breakable) continue;
      stress.pressing = averaged(world, actor, on_it);
      stress.spin_R = spin_felt(actor, states[actor.body]);
      // What falls freely feels nothing but its spin.
      if (!actor.is_static && stress.pressing.empty() && stress.spin_R.isZero()) continue;
      if (stress.settled && (changed(world, actor) || spin_changed(stress))) {
        stress.settled = false;
        stress.since_step = world.clock.step;
      }
      if (!stress.settled) found.emplace_back(stress.since_step, actor.key);
    }
  };
  auto waiting = collect_chunks<Waiting>(world.actors.size(), kActors, look);
  std::sort(waiting.begin(), waiting.end());
  std::vector<std::uint32_t> keys;
  for (const auto& [since, key] : waiting) keys.push_back(key);
  return keys;
}

std::vector<std::uint32_t> find_due(World& world) {
  WorkSpan span(world.ledger.work, Stage::kLoad, "solids due");
  std::vector<std::uint32_t> keys = due(world);
  span.count(keys.size());
  return keys;
}

StressAnswer judge(const World& world, const Breaker& breaker, const Actor& actor,
                   const Quat& rotation_WB, std::uint64_t most_work) {
  std::vector<Load> loads;
  LoadCase load = bearing(world, actor, rotation_WB, loads);
  load.most_work = most_work;
  return breaker.stress(actor.structure, load);
}

struct Judged {
  std::uint32_t key = 0;
  std::uint64_t most_work = 0;
  StressAnswer answer;
  double ms = 0;
};

/// Judges all, each within the work that is reserved for it.
void judge_all(const World& world, const Breaker& breaker, std::vector<Judged>& batch) {
  const BodyStates states = world.physics->states();
  const auto one = [&](Judged& judged) {
    const Stopwatch watch;
    const Actor& actor = *world.actors.find(judged.key);
    judged.answer =
        judge(world, breaker, actor, states[actor.body].X_WB.rotation, judged.most_work);
    judged.ms = watch.ms();
  };
  const auto large = [&](const Judged& judged) { return is_large(*world.actors.find(judged.key)); };
  for_chunks(batch.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    if (!large(batch[i])) one(batch[i]);
  });
  for (Judged& judged : batch) {
    if (large(judged)) one(judged);
  }
}

/// Does to the actor what the answer says.
void apply(World& world, Judged& judged) {
  Actor& actor = *world.actors.find(judged.key);
  StressAnswer& answer = judged.answer;
  actor.stress.judged = actor.stress.pressing;
  actor.stress.judged_spin_R = actor.stress.spin_R;
  actor.stress.memory = answer.memory;
  actor.stress.settled = answer.settled;
  actor.stress.since_step = world.clock.step;
  BreakEdit& edit = answer.edit;
  if (!edit.changed) {
    actor.structure.apply(edit);
    return;
  }
  if (!has_room(world, edit)) {
    ++world.ledger.report.limits_hit;
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
  BreakEvent event = break_of(world, actor, material);
  event.point_W = X_WB * Vec3(middle_R - actor.weight.com_R);
  event.new_area_m2 = edit.loose.new_area_m2;
  event.plan_ms = judged.ms;
  event.pieces = pieces_after(actor.structure, edit);
  const bool only_bends = !edit.hinges.empty() && edit.cut.empty();
  event.child_keys = carry_out(world, judged.key, edit);
  const bool opens_overlap = edit.loose.pieces.empty();
  if (!only_bends && !opens_overlap) world.ledger.breaks.push_back(std::move(event));
}

}  // namespace

void LoadStage::prepare(World& world, const Breaker& breaker) const {
  std::vector<Judged> batch;
  for (const Actor& actor : world.actors) {
    if (actor.stress.breakable && is_large(actor)) batch.push_back({actor.key, 0, {}, 0});
  }
  judge_all(world, breaker, batch);
  for (Judged& judged : batch) {
    world.actors.find(judged.key)->stress.memory = std::move(judged.answer.memory);
  }
}

void LoadStage::begin_frame() {
  work_left_ = std::min(kSavedFrames * work_a_frame_, work_left_ + work_a_frame_);
}

void LoadStage::run(World& world, const Breaker& breaker) {
  const bool any = std::any_of(world.actors.begin(), world.actors.end(),
                               [](const Actor& actor) { return actor.stress.breakable; });
  waiting_ = 0;
  if (!any) return;
  const std::vector<std::uint32_t> keys = find_due(world);
  std::size_t next = 0;
  while (next < keys.size() && work_left_ > 0) {
    std::vector<Judged> batch;
    auto left = static_cast<std::uint64_t>(work_left_);
    for (; next < keys.size() && left > 0; ++next) {
      const std::uint64_t bonds = world.actors.find(keys[next])->structure.bond_count();
      const std::uint64_t reserved = std::min(left, kReserve * (bonds + 1));
      batch.push_back({keys[next], reserved, {}, 0});
      left -= reserved;
    }
    WorkSpan span(world.ledger.work, Stage::kLoad, "solids judged");
    span.count(batch.size());
    judge_all(world, breaker, batch);
    for (Judged& judged : batch) {
      work_left_ -= static_cast<std::int64_t>(judged.answer.work);
      world.ledger.work.add({Stage::kLoad, "bonds visited", judged.answer.work});
      apply(world, judged);
    }
  }
  waiting_ = static_cast<std::uint32_t>(keys.size() - next);
  if (work_left_ > 0) work_left_ -= static_cast<std::int64_t>(rejoin(world, breaker));
}

}  // namespace sunder
