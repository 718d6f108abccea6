// Stage `break`: what breaks, decided before the solve, so that a wall that breaks does not first
// stop the ball.
//
// Read first: break_stage(), then decide(). Break probes (break_probe.h) tell what the breakable
// solids would have to bear. A solid breaks if the work exceeds the toughness times the crack's
// area, and the impulse the strength. Exactly that energy is taken from the motion; the pieces
// inherit the velocity field of the whole.
#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "engine/base/trace.h"
#include "engine/world/actors/replace.h"
#include "engine/world/break/clusters.h"

namespace sunder {
namespace {

constexpr int kRounds = 8;  // solids that can break one behind the other within one step
// An impact with less than this part of what the last fruitless plan asked for is not planned.
constexpr double kWorthPlanning = 0.7;
constexpr int kAdmitted = 3;  // clusters that have waited and are looked at in one round

/// An impact and what it would do.
struct Planned {
  Impact impact;
  std::uint32_t load = 0;  ///< Index in the probe's answer.
  BreakCommand command;
  BreakEdit edit;
  double plan_ms = 0;
  double needed_J = 0;
};

/// A probe under way.
struct Trial {
  BreakProbe probe;
  bool asked = false;  ///< What it has to bear is known, but not decided.
  std::vector<ProbeLoad> loads = {};
  std::vector<Planned> planned = {};
};

/// Energy that the new crack surface takes; each crack has two sides.
double crack_energy_J(const World& world, const Structure& structure, const BreakEdit& edit) {
  double energy = 0;
  for (const ExposedFace& face : edit.loose.exposed) {
    const Convex& convex = edit.exposed_convex(structure, face);
    energy += 0.5 * face.area_m2 * world.material(convex.material).toughness_J_m2;
  }
  return energy;
}

void prepare(World& world, Planned& planned) {
  const Impact& impact = planned.impact;
  const Actor& actor = *world.find(impact.key);
  const Pose X_WB = world.physics->state(actor.body).X_WB;
  Hit hit;
  hit.point_R = X_WB.inverse() * impact.point_W + actor.weight.com_R;
  hit.direction_R = X_WB.rotation.conjugate() * impact.direction_W;
  hit.convex = impact.convex;
  hit.energy_J = impact.energy_J;
  const std::uint64_t event = world.next_event++;
  // Of the actor: hit once more, it would break the same way, or an impact that comes in several
  // steps would be given several chances.
  const std::uint64_t seed = combine(world.scene.seed, impact.key);
  const Convex& convex = *actor.structure.convex(impact.convex);
  planned.command =
      world.breaker->command(convex, world.material(convex.material), hit, event, seed);
}

void plan_all(World& world, std::span<Planned* const> all) {
  for_chunks(all.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      Planned& planned = *all[i];
      const Stopwatch watch;
      const Structure& structure = world.find(planned.impact.key)->structure;
      planned.edit = world.breaker->plan(structure, planned.command);
      planned.plan_ms = watch.ms();
      planned.needed_J = crack_energy_J(world, structure, planned.edit);
    }
  });
}

/// How many parts an impact cuts, about: what it costs follows that (docs/decisions/032).
std::uint32_t parts_of(World& world, const Planned& planned) {
  constexpr std::size_t kPartsOfConvex = 8;
  const BreakCommand& command = planned.command;
  const Structure& structure = world.find(planned.impact.key)->structure;
  const std::size_t reached = structure.within(command.X_RP.position, command.radius_m).size();
  const auto cells = static_cast<std::size_t>(command.pattern.cell_count());
  return static_cast<std::uint32_t>(cells + kPartsOfConvex * reached);
}

/// Whether the frame's budget allows for the impacts, which are made ready. A frame that has spent
/// none yet can afford anything, or what costs more than a frame has would wait for ever.
bool afford(World& world, std::span<Planned> all) {
  std::uint32_t parts = 0;
  for (Planned& planned : all) {
    prepare(world, planned);
    parts += parts_of(world, planned);
  }
  const bool untouched = world.parts_left == world.scene.limits.parts_a_frame;
  if (parts > world.parts_left && !untouched) {
    world.parts_left = 0;  // for what comes later, too, however cheap
    return false;
  }
  world.parts_left -= std::min(world.parts_left, parts);
  return true;
}

/// Breaks the actor of an impact that has paid for it.
void break_actor(World& world, Planned& planned) {
  const Impact& impact = planned.impact;
  const std::uint32_t pieces = pieces_after(world.find(impact.key)->structure, planned.edit);
  world.breaks.push_back({world.time_s(), impact.key, impact.point_W, planned.needed_J,
                          planned.edit.loose.new_area_m2, planned.plan_ms, pieces});
  world.report.failed += planned.edit.loose.failed;
  carry_out(world, impact.key, planned.edit);
}

/// Whether the impact's plan could be carried out; remembers what it asked for, if not.
bool worth(World& world, const Planned& planned) {
  Actor& actor = *world.find(planned.impact.key);
  const double energy_J = planned.impact.energy_J;
  const bool breaks = planned.edit.changed;
  if (breaks && energy_J > planned.needed_J) return has_room(world, planned.edit);
  actor.least_J =
      std::max(actor.least_J, breaks ? kWorthPlanning * planned.needed_J : 1.4 * energy_J);
  return false;
}

/// Impacts that come with an energy of their own: those of blasts.
bool break_by_blasts(World& world) {
  std::vector<Planned> all;
  for (Impact& impact : std::exchange(world.waiting, {})) {
    const auto same = [&](const Planned& known) { return known.impact.key == impact.key; };
    const Actor* actor = world.find(impact.key);
    if (!actor || !actor->structure.has(impact.convex) || std::ranges::any_of(all, same)) continue;
    Planned planned;
    planned.impact = impact;
    if (afford(world, std::span(&planned, 1))) {
      all.push_back(std::move(planned));
    } else {
      world.waiting.push_back(impact);
    }
  }
  std::vector<Planned*> pointers;
  for (Planned& planned : all) pointers.push_back(&planned);
  plan_all(world, pointers);
  bool broke = false;
  for (Planned& planned : all) {
    if (!worth(world, planned)) continue;
    break_actor(world, planned);
    broke = true;
  }
  return broke;
}

/// The impacts that a probe's loads amount to, if they are strong enough for the material.
void add_impacts(World& world, Trial& trial) {
  trial.planned.clear();
  for (std::uint32_t i = 0; i < trial.loads.size(); ++i) {
    const ProbeLoad& load = trial.loads[i];
    const Actor& actor = *world.find(trial.probe.bodies()[load.body].key);
    const Material& material = world.material(actor.structure.convex(load.shape)->material);
    if (!material.breakable() || load.impulse_Ns < material.strength_Ns) continue;
    Planned planned;
    planned.load = i;
    planned.impact.key = actor.key;
    planned.impact.convex = load.shape;
    planned.impact.point_W = world.physics->state(actor.body).X_WB.position + load.arm_W;
    planned.impact.direction_W = load.direction_W;
    planned.impact.energy_J = load.work_J;
    trial.planned.push_back(std::move(planned));
  }
}

/// Takes over how the bodies move now that something gave way.
void take_over(World& world, const BreakProbe& probe) {
  for (std::size_t b = 0; b < probe.bodies().size(); ++b) {
    const ProbeMotion& motion = probe.motions()[b];
    if (!motion.changed) continue;
    const Actor& actor = *world.find(probe.bodies()[b].key);
    BodyState state = world.physics->state(actor.body);
    state.X_WB.position += motion.shift_W;
    state.X_WB.rotation = (rotation_by(motion.turn_W) * state.X_WB.rotation).normalized();
    state.velocity_W = motion.velocity_W;
    state.angular_velocity_W = motion.angular_velocity_W;
    world.physics->set_state(actor.body, state);
  }
}

/// The bodies of a trial that is over the budget sit out this step, at the place of the hit: it is
/// decided first in the next.
void wait(World& world, Trial& trial, std::vector<Waiter>& waiters) {
  trial.probe.pause();
  take_over(world, trial.probe);
  std::vector<BodyId> bodies;
  for (const ProbeBody& body : trial.probe.bodies()) {
    if (body.inverse_mass <= 0) continue;
    const auto known = std::ranges::lower_bound(world.waiters, body.key, {}, &Waiter::key);
    const bool waited = known != world.waiters.end() && known->key == body.key;
    waiters.push_back({body.key, waited ? known->since_step : world.step, world.next_waiting});
    bodies.push_back(world.find(body.key)->body);
  }
  world.physics->pause(bodies);
  ++world.next_waiting;
  ++world.trials_waiting;
}

/// What waits since earlier steps, in the order in which it is to be decided: cluster by cluster,
/// the longest waiting first.
std::vector<Waiter> queue_of(World& world) {
  std::vector<Waiter> queue = world.waiters;
  std::erase_if(queue, [&](const Waiter& waiter) { return !world.find(waiter.key); });
  std::ranges::sort(queue, {}, [](const Waiter& waiter) {
    return std::tuple(waiter.since_step, waiter.cluster, waiter.key);
  });
  return queue;
}

/// Takes the first clusters out of the queue.
void admit(std::vector<Waiter>& queue) {
  std::size_t end = 0;
  for (int clusters = 0; clusters < kAdmitted && end < queue.size(); ++clusters) {
    const std::uint64_t cluster = queue[end].cluster;
    while (end < queue.size() && queue[end].cluster == cluster) ++end;
  }
  queue.erase(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(end));
}

/// What is still in the queue waits on, as it is.
void wait_on(World& world, const std::vector<Waiter>& queue, std::vector<Waiter>& waiters) {
  std::vector<BodyId> bodies;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    bodies.push_back(world.find(queue[i].key)->body);
    if (i == 0 || queue[i].cluster != queue[i - 1].cluster) ++world.trials_waiting;
  }
  world.physics->pause(bodies);
  waiters.insert(waiters.end(), queue.begin(), queue.end());
}

/// Whether what a trial hits is among what others broke: a body that is gone, or the convex hit of
/// one that stands.
bool is_stale(World& world, const Trial& trial, std::span<const std::uint32_t> broken) {
  const std::vector<ProbeBody>& bodies = trial.probe.bodies();
  for (const std::uint32_t key : broken) {
    const auto body = std::ranges::find(bodies, key, &ProbeBody::key);
    if (body == bodies.end()) continue;
    const Actor* actor = world.find(key);
    if (!actor) return true;
    const auto index = static_cast<std::uint32_t>(body - bodies.begin());
    for (const ProbeContact& contact : trial.probe.contacts()) {
      if (contact.a == index && !actor->structure.has(contact.shape_a)) return true;
      if (contact.b == index && !actor->structure.has(contact.shape_b)) return true;
    }
  }
  return false;
}

/// Breaks what a trial can pay for, if anything, and adds it to `all_broken`.
bool settle(World& world, Trial& trial, std::vector<std::uint32_t>& all_broken) {
  std::vector<ProbeBreak> wanted;
  std::vector<std::uint32_t> of_load(trial.loads.size());
  for (std::uint32_t i = 0; i < trial.planned.size(); ++i) {
    of_load[trial.planned[i].load] = i;
    if (worth(world, trial.planned[i])) {
      wanted.push_back({trial.planned[i].load, trial.planned[i].needed_J});
    }
  }
  const std::vector<std::uint32_t> broken = trial.probe.release(wanted);
  if (broken.empty()) return false;
  take_over(world, trial.probe);
  for (const std::uint32_t load : broken) {
    Planned& planned = trial.planned[of_load[load]];
    break_actor(world, planned);
    all_broken.push_back(planned.impact.key);
  }
  return true;
}

/// Takes out the trials that hit a solid that stands where an earlier one hits it, too: whether it
/// is still there is only known when that one is decided.
std::vector<Trial> leave_for_later(World& world, std::vector<Trial>& trials) {
  std::set<std::uint32_t> claimed;
  std::vector<Trial> now, later;
  for (Trial& trial : trials) {
    std::set<std::uint32_t> hit;
    for (const Planned& planned : trial.planned) {
      if (world.find(planned.impact.key)->is_static) hit.insert(planned.impact.key);
    }
    const bool taken = std::ranges::any_of(hit, [&](auto key) { return claimed.contains(key); });
    if (!taken) claimed.insert(hit.begin(), hit.end());
    (taken ? later : now).push_back(std::move(trial));
  }
  trials = std::move(now);
  return later;
}

/// Follows all probes until each has broken something or come to the end of the step, or has to
/// wait (if it is not `in_time`, or too costly); true if another round is due. What another trial
/// has broken meanwhile is hit again in that round, as what became of it.
bool decide(World& world, std::vector<Trial>& trials, bool in_time, std::vector<Waiter>& waiters) {
  bool again = false;
  std::vector<std::uint32_t> broken;  // since the stale ones were sorted out
  while (!trials.empty()) {
    for_chunks(trials.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!std::exchange(trials[i].asked, true)) trials[i].loads = trials[i].probe.next();
      }
    });
    std::erase_if(trials, [](const Trial& trial) { return trial.loads.empty(); });
    const auto stale = [&](const Trial& trial) { return is_stale(world, trial, broken); };
    again |= std::erase_if(trials, stale) > 0;
    broken.clear();
    for (Trial& trial : trials) add_impacts(world, trial);
    std::vector<Trial> next = leave_for_later(world, trials);
    std::vector<Trial> affordable;
    for (Trial& trial : trials) {
      if (trial.planned.empty() || (in_time && afford(world, trial.planned))) {
        affordable.push_back(std::move(trial));
      } else {
        wait(world, trial, waiters);
      }
    }
    trials = std::move(affordable);
    std::vector<Planned*> planned;
    for (Trial& trial : trials) {
      for (Planned& one : trial.planned) planned.push_back(&one);
    }
    plan_all(world, planned);
    for (Trial& trial : trials) {
      if (stale(trial) || settle(world, trial, broken)) {
        again = true;
        continue;
      }
      trial.probe.hold();
      trial.asked = false;
      next.push_back(std::move(trial));
    }
    trials = std::move(next);
  }
  return again;
}

}  // namespace

void break_stage(World& world) {
  const auto collide = [&] { world.physics->collide(world.horizon_s()); };
  if (break_by_blasts(world)) collide();
  world.trials_waiting = 0;
  std::vector<Waiter> queue = queue_of(world), waiters;
  for (int round = 0; round <= kRounds; ++round) {
    const bool in_time = round < kRounds;
    const bool affordable = in_time && world.parts_left > 0;
    if (affordable) admit(queue);
    std::vector<Waiter> left_out = waiters;
    left_out.insert(left_out.end(), queue.begin(), queue.end());
    std::vector<Trial> trials;
    for (BreakProbe& probe : find_clusters(world, left_out)) {
      trials.push_back({std::move(probe)});
    }
    if (decide(world, trials, in_time, waiters)) {
      collide();
    } else if (!affordable || queue.empty()) {
      break;
    }
  }
  std::erase_if(queue, [&](const Waiter& waiter) { return !world.find(waiter.key); });
  wait_on(world, queue, waiters);
  std::ranges::sort(waiters, {}, &Waiter::key);
  world.waiters = std::move(waiters);
}

}  // namespace sunder
