// Stage `act`: what the script does to the world at this time; and making room when it is full.
//
// Read first: act_stage() and push_stage(). Acts come before contacts are found, pushes after
// breaks were decided, so that what a blast breaks off is what it blows away.
#include <algorithm>
#include <cmath>

#include "engine/world/actors/actors.h"
#include "engine/world/actors/joints.h"
#include "engine/world/actors/replace.h"

namespace sunder {
namespace {

constexpr std::uint32_t kRoom = 16;  // one part in so many bodies is kept free for breaks

/// Whether something due at `time_s` happens in this step.
bool is_due(const World& world, double time_s) {
  return time_s <= world.time_s() + 0.5 * world.scene.accuracy.dt_s;
}

/// The elements that have become due since the last step.
template <class Act>
std::span<const Act> due(const World& world, const std::vector<Act>& acts, std::size_t& next) {
  const std::size_t first = next;
  while (next < acts.size() && is_due(world, acts[next].time_s)) ++next;
  return std::span(acts).subspan(first, next - first);
}

void shoot(World& world) {
  for (const Shot& shot : due(world, world.scene.shots, world.next_shot)) {
    if (shot.hangs_from_W) {
      hang(world, shot);
    } else {
      add_ball(world, shot.ball);
    }
  }
}

void drop(World& world, const std::vector<std::size_t>& gone) {
  std::vector<BodyId> bodies;
  for (const std::size_t i : gone) {
    bodies.push_back(world.actors[i].body);
    cut_joints(world, world.actors[i].key);
  }
  world.physics->replace(bodies, {});
  for (auto i = gone.rbegin(); i != gone.rend(); ++i) {
    world.actors.erase(world.actors.begin() + static_cast<std::ptrdiff_t>(*i));
  }
}

/// What has lost an anchor goes on as it was, held by the others or by nothing.
void loosen(World& world, const Box& region_W) {
  std::vector<std::uint32_t> loosened;
  for (Actor& actor : world.actors) {
    if (!actor.is_static) continue;
    const Pose X_WB = world.physics->state(actor.body).X_WB;
    std::vector<std::uint32_t> slots;
    actor.structure.for_each([&](std::uint32_t slot, const Convex& convex) {
      const Vec3 at_W = X_WB * (convex.solid.centroid - actor.weight.com_R);
      const bool inside = (at_W.array() >= region_W.min.array()).all() &&
                          (at_W.array() <= region_W.max.array()).all();
      if (inside && actor.structure.anchored(slot) != 0) slots.push_back(slot);
    });
    for (const std::uint32_t slot : slots) actor.structure.loosen(slot);
    if (!slots.empty()) loosened.push_back(actor.key);
  }
  for (const std::uint32_t key : loosened) {
    BreakEdit nothing_more;
    carry_out(world, key, nothing_more);
  }
}

void remove(World& world) {
  for (const Removal& removal : due(world, world.scene.removals, world.next_removal)) {
    if (removal.roots.empty()) {
      loosen(world, removal.anchors_W);
      continue;
    }
    std::vector<std::size_t> gone;
    for (std::size_t i = 0; i < world.actors.size(); ++i) {
      if (std::ranges::binary_search(removal.roots, world.actors[i].root_key)) gone.push_back(i);
    }
    for (const std::size_t i : gone) world.removed_mass_kg += world.actors[i].weight.mass_kg;
    drop(world, gone);
  }
}

/// The smallest fragments at rest become debris once bodies are more than the scene wants.
void age(World& world) {
  const Limits& limits = world.scene.limits;
  const std::uint32_t most =
      limits.ageing > 0 ? std::min(limits.ageing, limits.bodies) : limits.bodies;
  if (world.actors.size() <= most - most / kRoom) return;
  std::vector<std::size_t> resting;
  for (std::size_t i = 0; i < world.actors.size(); ++i) {
    const Actor& actor = world.actors[i];
    const bool fragment = actor.key != actor.root_key && !actor.structure.empty();
    if (fragment && !actor.is_static && world.physics->state(actor.body).asleep) {
      resting.push_back(i);
    }
  }
  // Ascending by key already: a stable order of equals.
  std::ranges::stable_sort(resting, {}, [&](std::size_t i) { return world.actors[i].volume_m3; });
  // Some more than must go, so that it is not done in every step.
  const std::size_t wanted = world.actors.size() - (most - 2 * (most / kRoom));
  resting.resize(std::min(resting.size(), wanted));
  std::ranges::sort(resting);
  for (const std::size_t i : resting) {
    const Actor& actor = world.actors[i];
    const BodyState state = world.physics->state(actor.body);
    const Pose X_WR{state.X_WB * Vec3(-actor.weight.com_R), state.X_WB.rotation};
    add_chip(world, actor.structure.compound(),
             {X_WR, state.X_WB.position, state.velocity_W, state.angular_velocity_W});
    world.debris_mass_kg += actor.weight.mass_kg;
    ++world.report.aged;
  }
  if (!resting.empty()) drop(world, resting);
}

void drive(World& world) {
  for (const Drive& drive : world.scene.drives) {
    if (!is_due(world, drive.time_s) || is_due(world, drive.until_s)) continue;
    for (const std::uint32_t root : drive.roots) {
      const Actor* actor = world.find(root);
      if (!actor || actor->is_static) continue;
      const BodyState state = world.physics->state(actor->body);
      Vec3 impulse = actor->weight.mass_kg * (drive.velocity_W - state.velocity_W);
      const double most = drive.force_N * world.scene.accuracy.dt_s;
      if (impulse.norm() > most) impulse *= most / impulse.norm();
      if (impulse.norm() > 0) {
        world.physics->apply_impulse(actor->body, impulse, state.X_WB.position);
      }
    }
  }
}

}  // namespace

void act_stage(World& world) {
  shoot(world);
  remove(world);
  light_blasts(world);
  age(world);
}

void push_stage(World& world) {
  push_blasts(world);
  drive(world);
}

}  // namespace sunder
