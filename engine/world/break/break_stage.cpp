// Steps of the stage, in order of execution.
#include "engine/world/break/break_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/model/work_log.h"
#include "engine/world/actors/check_state.h"
#include "engine/world/actors/load_case.h"
#include "engine/world/break/cluster_probe.h"
#include "engine/world/break/clusters.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

bool parts_at_bonds(const Material& material) {
  return material.breaks_by_load() && !material.yields();
}

/// Makes the planned breaks of a trial from the loads that are strong enough for the material.
void add_impacts(const WorldState& world, Trial& trial) {
  trial.planned.clear();
  const BodyStates states = world.physics->states();
  for (std::uint32_t i = 0; i < trial.loads.size(); ++i) {
    const ImpactLoad& load = trial.loads[i];
    const Actor& actor = *world.actors.find(trial.probe->bodies()[load.body].key);
    const ConvexSlot slot(load.shape);
    const Material& material = world.material(actor.structure.convex(slot)->material);
    PlannedBreak planned;
    planned.load = i;
    planned.striker = trial.probe->bodies()[load.striker].key;
    for (const std::uint32_t rider : load.riders)
      planned.riders.push_back(trial.probe->bodies()[rider].key);
    planned.striker_J = load.striker_J;
    planned.speed_m_s = load.speed_m_s;
    planned.path_m_s_W = load.path_m_s_W;
    planned.time_s = load.time_s;
    planned.impulse_Ns = load.impulse_Ns;
    planned.by_pattern =
        breaks_where_struck(world, actor, load, world.actors.find(planned.striker));
    // A material without a pattern parts at the bonds around the striker.
    planned.by_pattern |= !material.breakable() && parts_at_bonds(material) &&
                          load.work_J > actor.stress.least_J &&
                          breaks_before_waves_arrive(material, load.speed_m_s);
    planned.transmitted_J = load.work_J;
    planned.by_stress =
        load.work_J > actor.stress.least_J && load.impulse_Ns > actor.stress.least_Ns;
    if (!planned.by_pattern && !planned.by_stress) continue;
    const Quat R_of_W = states[actor.body].X_WB.rotation.conjugate();
    for (const ProbeImpulse& impulse : load.impulses) {
      const Vec3 at_R = R_of_W * impulse.arm_W + actor.weight.com_R;
      const Vec3 impulse_R = R_of_W * impulse.impulse_W, angular_R = R_of_W * impulse.angular_W;
      if (impulse.shape == ProbeImpulse::kNearestShape) {
        add_joint_load(actor.structure, at_R, impulse_R, angular_R, planned.impulses);
      } else {
        planned.impulses.push_back({ConvexSlot(impulse.shape), impulse_R, at_R, angular_R});
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

/// Returns true if a body of a trial was broken by other trials: if the body is gone, a convex with
/// a contact is gone, or the body has a joint or rope.
bool is_stale(const WorldState& world, const Trial& trial, std::span<const std::uint32_t> broken) {
  const std::vector<ProbeBody>& bodies = trial.probe->bodies();
  for (const std::uint32_t key : broken) {
    const auto body = std::ranges::find(bodies, key, &ProbeBody::key);
    if (body == bodies.end()) continue;
    const Actor* actor = world.actors.find(key);
    if (!actor) return true;
    const auto index = static_cast<std::uint32_t>(body - bodies.begin());
    const auto is_gone = [&](std::uint32_t shape) {
      return !actor->structure.has(ConvexSlot(shape));
    };
    for (const ProbeContact& contact : trial.probe->contacts()) {
      if (contact.a == index && (contact.rope || is_gone(contact.shape_a))) return true;
      if (contact.b == index && (contact.rope || is_gone(contact.shape_b))) return true;
    }
    for (const ProbeJoint& joint : trial.probe->joints()) {
      if (joint.a == index || joint.b == index) return true;
    }
  }
  return false;
}

bool is_worth_deferring(const WorldState& world, const Trial& trial) {
  return std::ranges::any_of(trial.planned, [&](const PlannedBreak& planned) {
    return planned.impact.energy_J > kMinDeferredShare * world.log.kinetic_J;
  });
}

/// Returns true if no impact of a trial breaks anything, but the plan of one is not finished.
bool is_undecided(const Trial& trial) {
  return std::ranges::none_of(trial.planned, &PlannedBreak::breaks) &&
         std::ranges::any_of(
             trial.planned, [](const PlannedBreak& planned) { return planned.stressed.undecided; });
}

/// Saves the progress of unfinished plans by stress for the next step.
void save_progress(WorldState& world, std::span<PlannedBreak> all) {
  for (PlannedBreak& planned : all)
    if (planned.stressed.undecided)
      world.actors.find(planned.impact.key)->stress.memory = std::move(planned.stressed.memory);
}

/// Returns true if the body of an impact goes through its striker: of two bodies that could give
/// way to each other, only one does.
bool goes_through_striker(const Trial& trial, const PlannedBreak& body) {
  return std::ranges::any_of(trial.planned, [&](const PlannedBreak& other) {
    const bool strikes = other.striker == body.impact.key ||
                         std::ranges::binary_search(other.riders, body.impact.key);
    return other.breaks && other.impact.key == body.striker && strikes &&
           goes_through(other.command);
  });
}

/// Carries out the breaks of a trial for which its energy suffices, and appends the keys of the
/// broken actors to `all_broken`. Returns false if there are none.
bool carry_out_breaks(WorldState& world, const Breaker& breaker, Trial& trial,
                      std::vector<std::uint32_t>& all_broken) {
  std::vector<ProbeBreak> wanted;
  std::vector<std::uint32_t> of_load(trial.loads.size());
  std::size_t pieces = 0;  // of the breaks so far
  for (std::uint32_t i = 0; i < trial.planned.size(); ++i) {
    const PlannedBreak& planned = trial.planned[i];
    of_load[planned.load] = i;
    if (goes_through_striker(trial, planned)) continue;
    const Outcome outcome = outcome_of(world, planned, pieces);
    record_outcome(world, planned, outcome);
    if (outcome != Outcome::kBreaks) continue;
    wanted.push_back({planned.load, planned.along_normal_J()});
    pieces += planned.edit.loose.pieces.size();
  }
  const std::vector<std::uint32_t> broken = trial.probe->release(wanted);
  if (broken.empty()) return false;
  WorkSpan span(world.log.work_counts, Stage::kBreak, "breaks carried out");
  span.count(broken.size());
  const auto bends = [&](auto load) { return trial.planned[of_load[load]].only_bends(); };
  // If all broken bodies only bend, they stay in the way, and the next round probes them.
  EnergyFlows& energy = world.log.report.energy;
  if (!std::ranges::all_of(broken, bends)) energy.contacts -= apply_motion(world, *trial.probe);
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

/// Removes and returns the trials that strike a static solid that an earlier trial strikes too:
/// their contacts may be gone once the earlier trial is resolved.
std::vector<Trial> postpone_conflicts(const WorldState& world, std::vector<Trial>& trials) {
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

PlannedBreak planned_by_blast(const Actor& actor, const ActorImpact& impact) {
  PlannedBreak planned;
  planned.impact = impact;
  planned.impulses = impact.impulses;
  std::erase_if(planned.impulses,
                [&](const AppliedForce& push) { return !actor.structure.has(push.convex); });
  for (const AppliedForce& push : planned.impulses) planned.impulse_Ns += push.force_N.norm();
  planned.transmitted_J = std::numeric_limits<double>::infinity();
  planned.by_pattern = impact.energy_J > 0;
  planned.by_stress = !planned.impulses.empty();
  return planned;
}

std::vector<Trial> find_trials(WorldState& world, const DeferredImpacts& deferred,
                               double min_energy_J) {
  WorkSpan span(world.log.work_counts, Stage::kBreak, "clusters found");
  std::vector<Trial> trials;
  LimitsHit& limits = world.log.report.limits;
  for (std::unique_ptr<ImpactProbe>& probe : find_clusters(world, deferred, min_energy_J, limits))
    trials.push_back({std::move(probe)});
  span.count(trials.size());
  return trials;
}

void plan(WorldState& world, const Breaker& breaker, std::span<PlannedBreak* const> all) {
  WorkSpan span(world.log.work_counts, Stage::kBreak, "breaks planned");
  span.count(all.size());
  plan_all(world, breaker, all);
  WorkItem parts{Stage::kBreak, "parts cut"}, visits{Stage::kBreak, "bonds visited"};
  for (const PlannedBreak* planned : all) {
    parts.count += planned->edit.added.size();
    for (const Compound& piece : planned->edit.loose.pieces) parts.count += piece.convexes.size();
    visits.count += planned->stressed.work;
  }
  world.log.work_counts.add(parts);
  world.log.work_counts.add(visits);
}

std::vector<PlannedBreak*> planned_in(std::vector<Trial>& trials) {
  std::vector<PlannedBreak*> all;
  for (Trial& trial : trials) {
    for (PlannedBreak& planned : trial.planned) all.push_back(&planned);
  }
  return all;
}

/// Moves an impact whose solid another blast has broken to the nearest piece of the solid; returns
/// false if there is no piece.
bool retarget(const WorldState& world, std::uint32_t root_key, ActorImpact& impact) {
  const Actor* known = world.actors.find(impact.key);
  if (known && known->structure.has(impact.convex)) return true;
  const BodyStates states = world.physics->states();
  double least_m = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) {
    if (actor.root_key != root_key || actor.structure.empty()) continue;
    const Vec3 point_R = rest_pose(actor, states[actor.body].X_WB).inverse() * impact.point_W;
    const double distance_m = distance_to(actor.structure, point_R);
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    impact.key = actor.key;
    impact.convex = nearest(actor.structure, point_R);
    impact.impulses.clear();  // they acted on convexes that are gone
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

/// Probes run in batches, those with the most energy first, so that the budget can stop them. A
/// probe with the initial state of an earlier one of the step without a break is not run again.
void BreakStage::run_probes(WorldState& world, std::vector<Trial>& trials) {
  WorkSpan span(world.log.work_counts, Stage::kBreak, "clusters asked");
  std::vector<Trial*> due;
  for (Trial& trial : trials) {
    if (!std::exchange(trial.loads_known, true)) due.push_back(&trial);
  }
  WorkItem visits{Stage::kBreak, "contacts visited"};
  for (std::size_t first = 0; first < due.size(); first += kProbesAtOnce) {
    const double min_energy_J = min_impact_energy_J(world);
    const std::span batch =
        std::span(due).subspan(first, std::min(kProbesAtOnce, due.size() - first));
    for_chunks(batch.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (Trial* trial : batch.subspan(begin, end - begin)) {
        if (trial->fingerprint == 0) trial->fingerprint = fingerprint(*trial->probe);
        if (!unbroken_probes_.contains(trial->fingerprint))
          trial->loads = trial->probe->next(min_energy_J);
      }
    });
    std::uint64_t evaluations = 0;
    for (Trial* trial : batch) {
      const std::uint64_t work = trial->probe->evaluations();
      evaluations += work - std::exchange(trial->charged, work);
      if (trial->probe->reached_limit()) ++world.log.report.limits[Limit::kProbeEvents];
    }
    budget_.charge(evaluations / kContactEvaluationsPerPart);
    visits.count += evaluations;
  }
  std::size_t probes_run = due.size();
  for (const Trial& trial : trials) {
    if (trial.loads.empty() && !unbroken_probes_.insert(trial.fingerprint).second) --probes_run;
  }
  span.count(probes_run);
  world.log.work_counts.add(visits);
  std::erase_if(trials, [](const Trial& trial) { return trial.loads.empty(); });
}

double BreakStage::min_impact_energy_J(const WorldState& world) const {
  return budget_.left() > 0 ? 0 : kMinDeferredShare * world.log.kinetic_J;
}

bool BreakStage::prepare_within_budget(WorldState& world, const Breaker& breaker,
                                       std::span<PlannedBreak> all) {
  std::uint32_t parts = 0;
  for (PlannedBreak& planned : all) {
    if (planned.by_stress && budget_.spent()) return false;
    if (!planned.by_pattern) continue;
    prepare_command(world, breaker, world.next_event++, planned);
    parts += parts_to_cut(world, planned);
  }
  return budget_.try_spend(parts);
}

void BreakStage::share_budget(std::span<PlannedBreak* const> resumable) const {
  const auto plans =
      static_cast<std::uint64_t>(std::ranges::count_if(resumable, &PlannedBreak::by_stress));
  for (PlannedBreak* planned : resumable)
    if (planned->by_stress)
      planned->max_bond_evaluations = kBondEvaluationsPerPart * budget_.left() / plans;
}

void BreakStage::defer(WorldState& world, Trial& trial) {
  trial.probe->end_early();
  world.log.report.energy.gravity += apply_motion(world, *trial.probe);
  deferred_impacts_.add(world, *trial.probe);
}

bool BreakStage::break_by_blasts(WorldState& world, const Breaker& breaker,
                                 std::span<const ActorImpact> impacts) {
  for (const ActorImpact& impact : impacts) {
    const auto same = [&](const ActorImpact& known) {
      return known.key == impact.key && known.blast == impact.blast;
    };
    if (std::ranges::none_of(deferred_blast_impacts_, same))
      deferred_blast_impacts_.push_back(impact);
  }
  bool broke = false;
  for (std::vector<ActorImpact> due = std::exchange(deferred_blast_impacts_, {}); !due.empty();) {
    std::vector<PlannedBreak> all;
    // If several blasts break a solid, each breaks the pieces that the one before has left.
    std::vector<std::pair<std::uint32_t, ActorImpact>> later;  // with root_key
    for (const ActorImpact& impact : due) {
      const Actor* actor = world.actors.find(impact.key);
      if (!actor || !actor->structure.has(impact.convex)) continue;
      const auto same = [&](const PlannedBreak& other) { return other.impact.key == impact.key; };
      if (std::ranges::any_of(all, same)) {
        later.emplace_back(actor->root_key, impact);
        continue;
      }
      PlannedBreak planned = planned_by_blast(*actor, impact);
      if (prepare_within_budget(world, breaker, std::span(&planned, 1))) {
        all.push_back(std::move(planned));
      } else {
        deferred_blast_impacts_.push_back(impact);
      }
    }
    std::vector<PlannedBreak*> pointers;
    for (PlannedBreak& planned : all) pointers.push_back(&planned);
    share_budget(pointers);
    plan(world, breaker, pointers);
    for (PlannedBreak& planned : all) {
      if (planned.stressed.undecided && !planned.breaks) {
        save_progress(world, std::span(&planned, 1));
        deferred_blast_impacts_.push_back(std::move(planned.impact));
        continue;
      }
      const Outcome outcome = outcome_of(world, planned);
      record_outcome(world, planned, outcome);
      if (outcome != Outcome::kBreaks) continue;
      break_actor(world, breaker, planned);
      broke = true;
    }
    due.clear();
    for (auto& [root_key, impact] : later)
      if (retarget(world, root_key, impact)) due.push_back(impact);
  }
  return broke;
}

bool BreakStage::resolve(WorldState& world, const Breaker& breaker, std::vector<Trial> trials,
                         bool rounds_left) {
  bool again = false;
  std::vector<std::uint32_t> broken;  // since stale trials were last removed
  while (!trials.empty()) {
    run_probes(world, trials);
    const auto stale = [&](const Trial& trial) { return is_stale(world, trial, broken); };
    again |= std::erase_if(trials, stale) > 0;
    broken.clear();
    for (Trial& trial : trials) add_impacts(world, trial);
    std::vector<Trial> next = postpone_conflicts(world, trials);
    std::vector<Trial> to_plan;
    for (Trial& trial : trials) {
      trial.may_defer =
          is_worth_deferring(world, trial) && deferred_impacts_.may_defer(world, *trial.probe);
      if (trial.planned.empty() ||
          (rounds_left && prepare_within_budget(world, breaker, trial.planned))) {
        to_plan.push_back(std::move(trial));
      } else if (trial.may_defer) {
        defer(world, trial);
      } else {
        ++world.log.report.limits[rounds_left ? Limit::kPartsAFrame : Limit::kBreakRounds];
        trial.planned.clear();  // nothing breaks
        to_plan.push_back(std::move(trial));
      }
    }
    std::vector<PlannedBreak*> resumable;
    for (Trial& trial : to_plan)
      if (!trial.planned.empty() && deferred_impacts_.may_defer(world, *trial.probe))
        for (PlannedBreak& planned : trial.planned) resumable.push_back(&planned);
    share_budget(resumable);
    const std::vector<PlannedBreak*> all = planned_in(to_plan);
    plan(world, breaker, all);
    for (const PlannedBreak* planned : all)
      budget_.charge(planned->stressed.work / kBondEvaluationsPerPart);
    const std::uint32_t first_key = world.actors.next_key();
    for (Trial& trial : to_plan) {
      if (!stale(trial) && trial.may_defer && is_undecided(trial)) {
        save_progress(world, trial.planned);
        defer(world, trial);
        continue;
      }
      if (stale(trial) || carry_out_breaks(world, breaker, trial, broken)) {
        again = true;
        continue;
      }
      trial.probe->keep_unbroken();
      trial.loads_known = false;
      next.push_back(std::move(trial));
    }
    // Making a body of a piece and colliding it takes about as long as cutting a part.
    budget_.charge(world.actors.next_key() - first_key);
    trials = std::move(next);
  }
  return again;
}

const char* BreakStage::wrong_field(const WorldState& world) const {
  const auto is_wrong = [&](const ActorImpact& impact) { return !is_possible(world, impact); };
  return std::ranges::any_of(deferred_blast_impacts_, is_wrong) ? "deferred_blast_impacts_"
                                                                : nullptr;
}

void BreakStage::run(WorldState& world, const Breaker& breaker,
                     std::span<const ActorImpact> impacts) {
  const auto collide = [&] {
    const WorkSpan span(world.log.work_counts, Stage::kBreak, "contacts found anew");
    world.physics->collide(world.clock.horizon_s());
    deferred_impacts_.invalidate_driven();
  };
  if (break_by_blasts(world, breaker, impacts)) collide();
  deferred_impacts_.begin_step(world);
  unbroken_probes_.clear();
  const std::uint32_t most_rounds = world.scene.limits.break_rounds;
  for (std::uint32_t round = 0; round <= most_rounds; ++round) {
    const bool rounds_left = round < most_rounds;
    const bool affordable = rounds_left && !budget_.spent();
    if (affordable) deferred_impacts_.release_first();
    std::vector<Trial> trials = find_trials(world, deferred_impacts_, min_impact_energy_J(world));
    if (resolve(world, breaker, std::move(trials), rounds_left)) {
      collide();
    } else if (!affordable || deferred_impacts_.queue_empty()) {
      break;
    }
  }
  deferred_impacts_.end_step(world);
}

std::uint32_t BreakStage::deferred() const {
  return static_cast<std::uint32_t>(deferred_blast_impacts_.size()) + deferred_impacts_.clusters();
}

}  // namespace sunder
