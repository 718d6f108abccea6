// Stage `break`: which approaches break what, decided before the solve, so that a wall that
// breaks does not first stop the ball.
//
// Read first: break_stage(). A blow breaks a solid if its energy at the contact exceeds the
// toughness times the crack's area, and its impulse the strength. Exactly that energy is taken
// from the relative motion of the pair; the pieces inherit the velocity field of the whole.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/trace.h"
#include "engine/world/replace.h"

namespace sunder {
namespace {

constexpr int kRounds = 3;  // solids that can break one behind the other within one step
// A crack through a solid of volume V is at least this part of V^(2/3); weaker blows are not
// planned.
constexpr double kLeastCrack = 0.05;
// A blow with less than this part of what the last fruitless plan asked for is not planned either.
constexpr double kWorthPlanning = 0.7;

/// How two bodies meet at a point, along a direction into the second.
struct Encounter {
  double speed_m_s = 0;
  double effective_mass_kg = 0;
  double energy_J() const { return 0.5 * effective_mass_kg * speed_m_s * speed_m_s; }
};

/// Adds one body's part: `sign` +1 for the one that hits, −1 for the one that is hit.
void meet(const World& world, const Actor* actor, double sign, const Vec3& point_W,
          const Vec3& direction_W, double& speed, double& inverse_mass) {
  if (!actor || actor->is_static) return;
  const BodyState state = world.physics->state(actor->body);
  const Vec3 arm = point_W - state.X_WB.position;
  speed += sign * direction_W.dot(state.velocity_W + state.angular_velocity_W.cross(arm));
  const Vec3 lever_B = state.X_WB.rotation.conjugate() * arm.cross(direction_W);
  inverse_mass +=
      1 / actor->weight.mass_kg + lever_B.dot(actor->weight.inertia_R.inverse() * lever_B);
}

Encounter encounter(const World& world, const Actor* hitter, const Actor* hit, const Vec3& point_W,
                    const Vec3& direction_W) {
  double speed = 0, inverse_mass = 0;
  meet(world, hitter, 1, point_W, direction_W, speed, inverse_mass);
  meet(world, hit, -1, point_W, direction_W, speed, inverse_mass);
  if (speed <= 0 || inverse_mass <= 0) return {};
  return {speed, 1 / inverse_mass};
}

/// The approaches between two bodies as one, weighted by speed.
struct PairBlow {
  Vec3 point_W = Vec3::Zero();
  Vec3 normal_W = Vec3::Zero();
  double weight = 0;
  double fastest = 0;
  std::uint32_t shape_a = 0, shape_b = 0;
};

using PairBlows = std::map<std::pair<std::uint32_t, std::uint32_t>, PairBlow>;

PairBlows blows_by_pair(std::span<const Approach> approaches) {
  PairBlows pairs;
  for (const Approach& approach : approaches) {
    PairBlow& blow = pairs[{approach.body_tag_a, approach.body_tag_b}];
    blow.point_W += approach.speed_m_s * approach.point_W;
    blow.normal_W += approach.speed_m_s * approach.normal_W;
    blow.weight += approach.speed_m_s;
    if (approach.speed_m_s > blow.fastest) {
      blow.fastest = approach.speed_m_s;
      blow.shape_a = approach.shape_tag_a;
      blow.shape_b = approach.shape_tag_b;
    }
  }
  return pairs;
}

/// Whether a blow could break the actor at all, short of planning the break.
bool worth_planning(const World& world, const Actor& actor, const Blow& blow) {
  const Material& material = world.material(actor.compound.convexes[blow.convex]->material);
  if (!material.breakable() || actor.born_step == world.step + 1) return false;
  if (actor.volume_m3 < material.smallest_break_m3) return false;
  if (blow.effective_mass_kg * blow.speed_m_s < material.strength_Ns) return false;
  const double radius = material.impact_radius_m;
  const double reach_m3 = std::min(actor.volume_m3, 4.2 * radius * radius * radius);
  const double least_J = material.toughness_J_m2 * kLeastCrack * std::cbrt(reach_m3 * reach_m3);
  return blow.energy_J > least_J && blow.energy_J > kWorthPlanning * actor.needs_J;
}

/// The strongest blow on each actor, strongest first.
std::vector<Blow> find_blows(World& world) {
  std::map<std::uint32_t, Blow> strongest;
  for (const auto& [keys, pair] : blows_by_pair(world.physics->approaches())) {
    if (pair.weight <= 0 || pair.normal_W.squaredNorm() <= 0) continue;
    for (const bool hits_b : {true, false}) {
      Blow blow;
      blow.key = hits_b ? keys.second : keys.first;
      blow.other_key = hits_b ? keys.first : keys.second;
      blow.convex = hits_b ? pair.shape_b : pair.shape_a;
      blow.point_W = pair.point_W / pair.weight;
      blow.direction_W = (hits_b ? 1.0 : -1.0) * pair.normal_W.normalized();
      const Actor* actor = world.find(blow.key);
      if (!actor || blow.convex >= actor->compound.convexes.size()) continue;
      const Encounter met =
          encounter(world, world.find(blow.other_key), actor, blow.point_W, blow.direction_W);
      blow.speed_m_s = met.speed_m_s;
      blow.effective_mass_kg = met.effective_mass_kg;
      blow.energy_J = met.energy_J();
      if (!worth_planning(world, *actor, blow)) continue;
      const auto [it, added] = strongest.emplace(blow.key, blow);
      if (!added && blow.energy_J > it->second.energy_J) it->second = blow;
    }
  }
  std::vector<Blow> blows;
  for (const auto& [key, blow] : strongest) blows.push_back(blow);
  std::stable_sort(blows.begin(), blows.end(),
                   [](const Blow& a, const Blow& b) { return a.energy_J > b.energy_J; });
  return blows;
}

/// A blow and what it would do.
struct Planned {
  Blow blow;
  BreakPlan plan;
  double plan_ms = 0;
};

std::vector<Planned> plan_breaks(World& world, const std::vector<Blow>& blows) {
  std::vector<Planned> planned(blows.size());
  std::vector<BreakCommand> commands(blows.size());
  for (std::size_t i = 0; i < blows.size(); ++i) {
    planned[i].blow = blows[i];
    const Blow& blow = blows[i];
    const Actor& actor = *world.find(blow.key);
    const Pose X_WB = world.physics->state(actor.body).X_WB;
    Hit hit;
    hit.point_R = X_WB.inverse() * blow.point_W + actor.weight.com_R;
    hit.direction_R = X_WB.rotation.conjugate() * blow.direction_W;
    hit.convex = blow.convex;
    hit.energy_J = blow.energy_J;
    const std::uint64_t event = world.next_event++;
    commands[i] = world.breaker->command(
        actor.compound, world.material(actor.compound.convexes[blow.convex]->material), hit, event,
        combine(world.scene.seed, event));
  }
  for_chunks(blows.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Stopwatch watch;
      planned[i].plan = world.breaker->plan(world.find(blows[i].key)->compound, commands[i]);
      planned[i].plan_ms = watch.ms();
    }
  });
  return planned;
}

/// Energy that the new crack surface takes; each crack has two sides.
double crack_energy_J(const World& world, const BreakPlan& plan) {
  double energy = 0;
  for (const ExposedFace& face : plan.exposed) {
    const Convex& convex = *plan.pieces[face.piece].convexes[face.convex];
    energy += 0.5 * face.area_m2 * world.material(convex.material).toughness_J_m2;
  }
  return energy;
}

/// Takes `energy_J` out of the relative motion along the blow, by an impulse on both.
void pay(World& world, const Blow& blow, const Encounter& met, double energy_J) {
  if (met.effective_mass_kg <= 0) return;
  const double left = met.speed_m_s * met.speed_m_s - 2 * energy_J / met.effective_mass_kg;
  const double impulse = met.effective_mass_kg * (met.speed_m_s - std::sqrt(std::max(0.0, left)));
  const Vec3 impulse_W = impulse * blow.direction_W;
  if (const Actor* other = world.find(blow.other_key)) {
    world.physics->apply_impulse(other->body, -impulse_W, blow.point_W);
  }
  world.physics->apply_impulse(world.find(blow.key)->body, impulse_W, blow.point_W);
}

/// Breaks the actor if the blow, as it is now, has the energy that the plan needs.
bool commit(World& world, Planned& planned) {
  const Blow& blow = planned.blow;
  Actor* actor = world.find(blow.key);
  const Actor* other = world.find(blow.other_key);
  const Encounter met = encounter(world, other, actor, blow.point_W, blow.direction_W);
  const double needed_J = crack_energy_J(world, planned.plan);
  // A blow that had to wait was stopped by the solve meanwhile: its energy is already gone.
  const double available_J = blow.waited ? blow.energy_J : met.energy_J();
  if (!planned.plan.broke() || available_J <= needed_J) {
    actor->needs_J = planned.plan.broke() ? needed_J : 2 * blow.energy_J;
    return false;
  }
  if (world.actors.size() + planned.plan.pieces.size() > world.scene.limits.bodies) {
    ++world.report.limits_hit;
    return false;
  }
  pay(world, blow, met, std::min(needed_J, met.energy_J()));
  const auto pieces = static_cast<std::uint32_t>(planned.plan.pieces.size());
  world.breaks.push_back({world.time_s(), actor->key, blow.point_W, needed_J,
                          planned.plan.new_area_m2, planned.plan_ms, pieces});
  replace_by_pieces(world, blow.key, planned.plan);
  return true;
}

/// The blows to decide in this round, those put off first; what exceeds the budget is put off.
std::vector<Blow> choose_blows(World& world) {
  std::vector<Blow> blows = std::exchange(world.waiting, {});
  std::erase_if(blows, [&](const Blow& blow) { return !world.find(blow.key); });
  for (const Blow& blow : find_blows(world)) {
    const auto same = [&](const Blow& known) { return known.key == blow.key; };
    if (std::none_of(blows.begin(), blows.end(), same)) blows.push_back(blow);
  }
  std::vector<Blow> chosen;
  for (Blow& blow : blows) {
    const Actor& actor = *world.find(blow.key);
    const Material& material = world.material(actor.compound.convexes[blow.convex]->material);
    const auto cells = static_cast<std::uint32_t>(material.pattern.cell_count());
    if (cells <= world.pieces_left) {
      world.pieces_left -= cells;
      chosen.push_back(blow);
    } else {
      blow.waited = true;
      world.waiting.push_back(blow);
    }
  }
  return chosen;
}

}  // namespace

void break_stage(World& world) {
  for (int round = 0; round < kRounds; ++round) {
    bool broke = false;
    for (Planned& planned : plan_breaks(world, choose_blows(world))) {
      const Blow& blow = planned.blow;
      const bool hitter_gone = !world.find(blow.other_key) && blow.other_key != kGroundKey;
      if (hitter_gone && !blow.waited) continue;  // it broke just now: its pieces try next round
      broke |= commit(world, planned);
    }
    if (!broke) return;
    world.physics->collide(world.scene.accuracy.dt_s);
  }
}

}  // namespace sunder
