// The steps of a decision, in their order.
#include "engine/world/break/break_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/model/work_log.h"
#include "engine/world/actors/bearing.h"
#include "engine/world/break/cluster_probe.h"
#include "engine/world/break/clusters.h"

namespace sunder {
namespace {

// A part takes about as long to cut as so many visits of bonds in a solve for stress.
constexpr std::uint64_t kVisitsAPart = 160;
// And as a probe's visits of contacts.
constexpr std::uint64_t kLooksAPart = 1000;
// Beyond the budget, an impact with less than this share of all kinetic energy holds: it does not
// wait, and is not looked at.
constexpr double kWorthWaiting = 1e-3;
constexpr std::size_t kAskedAtOnce = 16;
constexpr int kRounds = 8;  // solids that can break one behind the other within one step

bool parts_at_bonds(const Material& material) {
  return material.breaks_by_load() && !material.yields();
}

/// The impacts that a probe's loads amount to, if they are strong enough for the material.
void add_impacts(const World& world, Trial& trial) {
  trial.planned.clear();
  const BodyStates states = world.physics->states();
  for (std::uint32_t i = 0; i < trial.loads.size(); ++i) {
    const ProbeLoad& load = trial.loads[i];
    const Actor& actor = *world.actors.find(trial.probe.bodies()[load.body].key);
    const ConvexSlot slot(load.shape);
    const Material& material = world.material(actor.structure.convex(slot)->material);
    PlannedBreak planned;
    planned.load = i;
    planned.striker = trial.probe.bodies()[load.striker].key;
    planned.speed_m_s = load.speed_m_s;
    planned.impulse_Ns = load.impulse_Ns;
    planned.by_pattern =
        breaks_where_struck(world, actor, load, world.actors.find(planned.striker));
    // A material without a pattern parts at the bonds around the striker.
    planned.by_pattern |= !material.breakable() && parts_at_bonds(material) &&
                          load.work_J > actor.stress.least_J &&
                          breaks_before_waves_arrive(material, load.speed_m_s);
    planned.far_J = load.work_J;
    planned.by_stress =
        load.work_J > actor.stress.least_J && load.impulse_Ns > actor.stress.least_Ns;
    if (!planned.by_pattern && !planned.by_stress) continue;
    const Quat R_of_W = states[actor.body].X_WB.rotation.conjugate();
    for (const ProbePush& push : load.pushes) {
      const Vec3 at_R = R_of_W * push.arm_W + actor.weight.com_R;
      const Vec3 impulse_R = R_of_W * push.impulse_W, angular_R = R_of_W * push.angular_W;
      if (push.shape == ProbePush::kNearest) {
        add_joint_load(actor.structure, at_R, impulse_R, angular_R, planned.impulses);
      } else {
        planned.impulses.push_back({ConvexSlot(push.shape), impulse_R, at_R, angular_R});
      }
    }
    planned.impact.key = actor.key;
    planned.impact.convex = slot;
    planned.impact.point_W = states[actor.body].X_WB.position + load.arm_W;
    planned.impact.direction_W = load.direction_W;
    planned.impact.energy_J = load.work_J;
    trial.planned.push_back(std::move(planned));
  }
}

/// Whether what a trial hits is among what others broke: a body that is gone, or, of one that
/// stands, the convex hit, or where a joint may have been.
bool is_stale(const World& world, const Trial& trial, std::span<const std::uint32_t> broken) {
  const std::vector<ProbeBody>& bodies = trial.probe.bodies();
  for (const std::uint32_t key : broken) {
    const auto body = std::ranges::find(bodies, key, &ProbeBody::key);
    if (body == bodies.end()) continue;
    const Actor* actor = world.actors.find(key);
    if (!actor) return true;
    const auto index = static_cast<std::uint32_t>(body - bodies.begin());
    const auto is_gone = [&](std::uint32_t shape) {
      return !actor->structure.has(ConvexSlot(shape));
    };
    for (const ProbeContact& contact : trial.probe.contacts()) {
      if (contact.a == index && (contact.rope || is_gone(contact.shape_a))) return true;
      if (contact.b == index && (contact.rope || is_gone(contact.shape_b))) return true;
    }
    for (const ProbeJoint& joint : trial.probe.joints()) {
      if (joint.a == index || joint.b == index) return true;
    }
  }
  return false;
}

bool is_worth_waiting(const World& world, const Trial& trial) {
  return std::ranges::any_of(trial.planned, [&](const PlannedBreak& planned) {
    return planned.impact.energy_J > kWorthWaiting * world.ledger.kinetic_J;
  });
}

/// True if some impact of a trial may break something, which is not known yet, and none does.
bool is_undecided(const Trial& trial) {
  return std::ranges::none_of(trial.planned, &PlannedBreak::breaks) &&
         std::ranges::any_of(
             trial.planned, [](const PlannedBreak& planned) { return planned.stressed.undecided; });
}

/// Keeps how far plans by stress have come, for the next step.
void keep_progress(World& world, std::span<PlannedBreak> all) {
  for (PlannedBreak& planned : all)
    if (planned.stressed.undecided)
      world.actors.find(planned.impact.key)->stress.memory = std::move(planned.stressed.memory);
}

/// Breaks what a trial can pay for, if anything, and adds it to `all_broken`.
bool settle(World& world, const Breaker& breaker, Trial& trial,
            std::vector<std::uint32_t>& all_broken) {
  std::vector<ProbeBreak> wanted;
  std::vector<std::uint32_t> of_load(trial.loads.size());
  std::size_t pieces = 0;  // of all that break
  for (std::uint32_t i = 0; i < trial.planned.size(); ++i) {
    const PlannedBreak& planned = trial.planned[i];
    of_load[planned.load] = i;
    const Verdict verdict = verdict_on(world, planned, pieces);
    note_verdict(world, planned, verdict);
    if (verdict != Verdict::kBreaks) continue;
    wanted.push_back({planned.load, planned.needed_J});
    pieces += planned.edit.loose.pieces.size();
  }
  const std::vector<std::uint32_t> broken = trial.probe.release(wanted);
  if (broken.empty()) return false;
  WorkSpan span(world.ledger.work, Stage::kBreak, "breaks carried out");
  span.count(broken.size());
  const auto bends = [&](auto load) { return trial.planned[of_load[load]].only_bends(); };
  // What only bends is still in the way, and is met as what it has become.
  EnergyFlows& energy = world.ledger.report.energy;
  if (!std::ranges::all_of(broken, bends)) energy.contacts -= take_over(world, trial.probe);
  for (const std::uint32_t load : broken) {
    PlannedBreak& planned = trial.planned[of_load[load]];
    energy.contacts -= planned.needed_J;
    energy.crushing += planned.crushing_J;
    energy.cracks += planned.needed_J - planned.crushing_J;
    break_actor(world, breaker, planned);
    all_broken.push_back(planned.impact.key);
  }
  return true;
}

/// Takes out the trials that hit a solid that stands where an earlier one hits it, too: whether it
/// is still there is only known when that one is decided.
std::vector<Trial> leave_for_later(const World& world, std::vector<Trial>& trials) {
  std::set<std::uint32_t> claimed;
  std::vector<Trial> now, later;
  for (Trial& trial : trials) {
    std::set<std::uint32_t> hit;
    for (const PlannedBreak& planned : trial.planned) {
      if (world.actors.find(planned.impact.key)->is_static) hit.insert(planned.impact.key);
    }
    const bool taken = std::ranges::any_of(hit, [&](auto key) { return claimed.contains(key); });
    if (!taken) claimed.insert(hit.begin(), hit.end());
    (taken ? later : now).push_back(std::move(trial));
  }
  trials = std::move(now);
  return later;
}

PlannedBreak planned_by_blast(const Actor& actor, const Impact& impact) {
  PlannedBreak planned;
  planned.impact = impact;
  planned.impulses = impact.pushes;
  std::erase_if(planned.impulses,
                [&](const Load& push) { return !actor.structure.has(push.convex); });
  for (const Load& push : planned.impulses) planned.impulse_Ns += push.force_N.norm();
  planned.far_J = std::numeric_limits<double>::infinity();
  planned.by_pattern = impact.energy_J > 0;
  planned.by_stress = !planned.impulses.empty();
  return planned;
}

std::vector<Trial> find_trials(World& world, const WaitingRoom& waiting, double least_J) {
  WorkSpan span(world.ledger.work, Stage::kBreak, "clusters found");
  std::vector<Trial> trials;
  for (BreakProbe& probe : find_clusters(world, waiting, least_J))
    trials.push_back({std::move(probe)});
  span.count(trials.size());
  return trials;
}

void plan(World& world, const Breaker& breaker, std::span<PlannedBreak* const> all) {
  WorkSpan span(world.ledger.work, Stage::kBreak, "breaks planned");
  span.count(all.size());
  plan_all(world, breaker, all);
  WorkItem parts{Stage::kBreak, "parts cut"}, visits{Stage::kBreak, "bonds visited"};
  for (const PlannedBreak* planned : all) {
    parts.count += planned->edit.added.size();
    for (const Compound& piece : planned->edit.loose.pieces) parts.count += piece.convexes.size();
    visits.count += planned->stressed.work;
  }
  world.ledger.work.add(parts);
  world.ledger.work.add(visits);
}

std::vector<PlannedBreak*> planned_in(std::vector<Trial>& trials) {
  std::vector<PlannedBreak*> all;
  for (Trial& trial : trials) {
    for (PlannedBreak& planned : trial.planned) all.push_back(&planned);
  }
  return all;
}

/// After another blast has broken the solid that an impact was to break: puts it on the nearest of
/// what came of that; false if nothing did.
bool find_again(const World& world, std::uint32_t root_key, Impact& impact) {
  const Actor* known = world.actors.find(impact.key);
  if (known && known->structure.has(impact.convex)) return true;
  const BodyStates states = world.physics->states();
  double least_m = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) {
    if (actor.root_key != root_key || actor.structure.empty()) continue;
    const Vec3 point_R = rest_pose(actor, states[actor.body].X_WB).inverse() * impact.point_W;
    const double distance_m = distance_outside(actor.structure, point_R);
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    impact.key = actor.key;
    impact.convex = nearest(actor.structure, point_R);
    impact.pushes.clear();  // they were those on what is gone
  }
  return std::isfinite(least_m);
}

}  // namespace

bool BreakBudget::try_spend(std::uint32_t parts) {
  if (parts > left_ && !untouched_) {
    left_ = 0;
    return false;
  }
  untouched_ = false;
  charge(parts);
  return true;
}

/// The probes that have not been asked are followed to their next loads, those with the most energy
/// first, some at a time so that the budget binds. Those without any are done, and so are those
/// that come again as they were when they held: what has broken since is no part of them.
void BreakStage::ask(World& world, std::vector<Trial>& trials) {
  WorkSpan span(world.ledger.work, Stage::kBreak, "clusters asked");
  std::vector<Trial*> due;
  for (Trial& trial : trials) {
    if (!std::exchange(trial.asked, true)) due.push_back(&trial);
  }
  WorkItem visits{Stage::kBreak, "contacts visited"};
  for (std::size_t first = 0; first < due.size(); first += kAskedAtOnce) {
    const double least_J = least_worth_J(world);
    const std::span batch =
        std::span(due).subspan(first, std::min(kAskedAtOnce, due.size() - first));
    for_chunks(batch.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (Trial* trial : batch.subspan(begin, end - begin)) {
        if (trial->fingerprint == 0) trial->fingerprint = fingerprint(trial->probe);
        if (!held_.contains(trial->fingerprint)) trial->loads = trial->probe.next(least_J);
      }
    });
    std::uint64_t looked_at = 0;
    for (Trial* trial : batch) {
      const std::uint64_t work = trial->probe.work();
      looked_at += work - std::exchange(trial->charged, work);
    }
    budget_.charge(looked_at / kLooksAPart);
    visits.count += looked_at;
  }
  std::size_t asked = due.size();
  for (const Trial& trial : trials) {
    if (trial.loads.empty() && !held_.insert(trial.fingerprint).second) --asked;
  }
  span.count(asked);
  world.ledger.work.add(visits);
  std::erase_if(trials, [](const Trial& trial) { return trial.loads.empty(); });
}

double BreakStage::least_worth_J(const World& world) const {
  return budget_.left() > 0 ? 0 : kWorthWaiting * world.ledger.kinetic_J;
}

bool BreakStage::take_on(World& world, const Breaker& breaker, std::span<PlannedBreak> all) {
  std::uint32_t parts = 0;
  for (PlannedBreak& planned : all) {
    if (planned.by_stress && budget_.spent()) return false;
    if (!planned.by_pattern) continue;
    prepare(world, breaker, world.next_event++, planned);
    parts += parts_to_cut(world, planned);
  }
  return budget_.try_spend(parts);
}

void BreakStage::share_out(std::span<PlannedBreak* const> resumable) const {
  const auto plans =
      static_cast<std::uint64_t>(std::ranges::count_if(resumable, &PlannedBreak::by_stress));
  for (PlannedBreak* planned : resumable)
    if (planned->by_stress) planned->most_visits = kVisitsAPart * budget_.left() / plans;
}

void BreakStage::wait(World& world, Trial& trial) {
  trial.probe.pause();
  world.ledger.report.energy.gravity += take_over(world, trial.probe);
  waiting_room_.add(world, trial.probe);
}

bool BreakStage::break_by_blasts(World& world, const Breaker& breaker,
                                 std::span<const Impact> impacts) {
  for (const Impact& impact : impacts) {
    const auto same = [&](const Impact& known) {
      return known.key == impact.key && known.blast == impact.blast;
    };
    if (std::ranges::none_of(impacts_waiting_, same)) impacts_waiting_.push_back(impact);
  }
  bool broke = false;
  for (std::vector<Impact> due = std::exchange(impacts_waiting_, {}); !due.empty();) {
    std::vector<PlannedBreak> all;
    // Of a solid that several blasts break, the next breaks what the one before has left.
    std::vector<std::pair<std::uint32_t, Impact>> later;  // by root
    for (const Impact& impact : due) {
      const Actor* actor = world.actors.find(impact.key);
      if (!actor || !actor->structure.has(impact.convex)) continue;
      const auto same = [&](const PlannedBreak& other) { return other.impact.key == impact.key; };
      if (std::ranges::any_of(all, same)) {
        later.emplace_back(actor->root_key, impact);
        continue;
      }
      PlannedBreak planned = planned_by_blast(*actor, impact);
      if (take_on(world, breaker, std::span(&planned, 1))) {
        all.push_back(std::move(planned));
      } else {
        impacts_waiting_.push_back(impact);
      }
    }
    std::vector<PlannedBreak*> pointers;
    for (PlannedBreak& planned : all) pointers.push_back(&planned);
    share_out(pointers);
    plan(world, breaker, pointers);
    for (PlannedBreak& planned : all) {
      if (planned.stressed.undecided && !planned.breaks) {
        keep_progress(world, std::span(&planned, 1));
        impacts_waiting_.push_back(std::move(planned.impact));
        continue;
      }
      const Verdict verdict = verdict_on(world, planned);
      note_verdict(world, planned, verdict);
      if (verdict != Verdict::kBreaks) continue;
      break_actor(world, breaker, planned);
      broke = true;
    }
    due.clear();
    for (auto& [root_key, impact] : later)
      if (find_again(world, root_key, impact)) due.push_back(impact);
  }
  return broke;
}

bool BreakStage::decide(World& world, const Breaker& breaker, std::vector<Trial> trials,
                        bool in_time) {
  bool again = false;
  std::vector<std::uint32_t> broken;  // since the stale ones were sorted out
  while (!trials.empty()) {
    ask(world, trials);
    const auto stale = [&](const Trial& trial) { return is_stale(world, trial, broken); };
    again |= std::erase_if(trials, stale) > 0;
    broken.clear();
    for (Trial& trial : trials) add_impacts(world, trial);
    std::vector<Trial> next = leave_for_later(world, trials);
    std::vector<Trial> taken_on;
    for (Trial& trial : trials) {
      trial.may_wait = is_worth_waiting(world, trial) && waiting_room_.may_wait(world, trial.probe);
      if (trial.planned.empty() || (in_time && take_on(world, breaker, trial.planned))) {
        taken_on.push_back(std::move(trial));
      } else if (trial.may_wait) {
        wait(world, trial);
      } else {
        trial.planned.clear();  // all holds
        taken_on.push_back(std::move(trial));
      }
    }
    std::vector<PlannedBreak*> resumable;
    for (Trial& trial : taken_on)
      if (!trial.planned.empty() && waiting_room_.may_wait(world, trial.probe))
        for (PlannedBreak& planned : trial.planned) resumable.push_back(&planned);
    share_out(resumable);
    const std::vector<PlannedBreak*> all = planned_in(taken_on);
    plan(world, breaker, all);
    for (const PlannedBreak* planned : all) budget_.charge(planned->stressed.work / kVisitsAPart);
    const std::uint32_t first_key = world.actors.next_key();
    for (Trial& trial : taken_on) {
      if (!stale(trial) && trial.may_wait && is_undecided(trial)) {
        keep_progress(world, trial.planned);
        wait(world, trial);
        continue;
      }
      if (stale(trial) || settle(world, breaker, trial, broken)) {
        again = true;
        continue;
      }
      trial.probe.hold();
      trial.asked = false;
      next.push_back(std::move(trial));
    }
    // A piece takes about as long to become a body and meet the others.
    budget_.charge(world.actors.next_key() - first_key);
    trials = std::move(next);
  }
  return again;
}

void BreakStage::run(World& world, const Breaker& breaker, std::span<const Impact> impacts) {
  const auto collide = [&] {
    const WorkSpan span(world.ledger.work, Stage::kBreak, "contacts found anew");
    world.physics->collide(world.clock.horizon_s());
    waiting_room_.forget_driven();
  };
  if (break_by_blasts(world, breaker, impacts)) collide();
  waiting_room_.begin_step(world);
  held_.clear();
  for (int round = 0; round <= kRounds; ++round) {
    const bool in_time = round < kRounds;
    const bool affordable = in_time && !budget_.spent();
    if (affordable) waiting_room_.admit();
    std::vector<Trial> trials = find_trials(world, waiting_room_, least_worth_J(world));
    if (decide(world, breaker, std::move(trials), in_time)) {
      collide();
    } else if (!affordable || waiting_room_.queue_empty()) {
      break;
    }
  }
  waiting_room_.end_step(world);
}

std::uint32_t BreakStage::waiting() const {
  return static_cast<std::uint32_t>(impacts_waiting_.size()) + waiting_room_.clusters();
}

}  // namespace sunder
