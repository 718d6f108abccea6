#include "engine/world/break/waiting_room.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace sunder {
namespace {

// A body that closes on a paused one faster than this is paused too: it would hit it like a wall.
constexpr double kRunsInto_m_s = 0.5;
constexpr int kAdmitted = 3;  // clusters that have waited and are looked at in one round

void pause_all(World& world, std::span<const Waiter> waiters) {
  std::vector<BodyId> bodies;
  for (const Waiter& waiter : waiters) bodies.push_back(world.actors.find(waiter.key)->body);
  world.physics->pause(bodies);
}

bool moves(const BodyState& state) {
  return !state.velocity_W.isZero(0) || !state.angular_velocity_W.isZero(0);
}

std::set<std::uint32_t> find_driven(const World& world) {
  std::set<std::uint32_t> driven;
  std::vector<BodyId> layer;
  const BodyStates states = world.physics->states();
  for (const Actor& actor : world.actors) {
    if (!actor.is_kinematic || !moves(states[actor.body])) continue;
    driven.insert(actor.key);
    layer.push_back(actor.body);
  }
  while (!layer.empty()) {
    const std::vector<TouchingBodies> touching = world.physics->touching(layer);
    layer.clear();
    for (const TouchingBodies& touch : touching) {
      for (const std::uint32_t key : {touch.tag_a, touch.tag_b}) {
        const Actor* actor = world.actors.find(key);
        if (!actor || actor->is_static || !driven.insert(key).second) continue;
        layer.push_back(actor->body);
      }
    }
  }
  return driven;
}

/// Returns true if `other` would hit a body at rest at a point where they may touch.
bool runs_into(const World& world, const BodyState& other, const Vec3& arm_W,
               const Vec3& to_other_W, double separation_m) {
  const Vec3 velocity_W = other.velocity_W + other.angular_velocity_W.cross(arm_W);
  const double closing_m_s = -velocity_W.dot(to_other_W);
  return closing_m_s > kRunsInto_m_s && closing_m_s * world.clock.dt_s > separation_m;
}

}  // namespace

void WaitingRoom::begin_step(const World& world) {
  clusters_ = 0;
  waiters_.clear();
  forget_driven();
  queue_ = last_;
  std::erase_if(queue_, [&](const Waiter& waiter) { return !world.actors.find(waiter.key); });
  if (queue_.empty()) return;
  driven_ = find_driven(world);
  std::set<std::uint64_t> leave;
  for (const Waiter& waiter : queue_)
    if (driven_->contains(waiter.key)) leave.insert(waiter.cluster);
  std::erase_if(queue_, [&](const Waiter& waiter) { return leave.contains(waiter.cluster); });
  std::ranges::sort(queue_, {}, [](const Waiter& waiter) {
    return std::tuple(waiter.since_step, waiter.cluster, waiter.key);
  });
}

void WaitingRoom::admit() {
  std::size_t end = 0;
  for (int clusters = 0; clusters < kAdmitted && end < queue_.size(); ++clusters) {
    const std::uint64_t cluster = queue_[end].cluster;
    while (end < queue_.size() && queue_[end].cluster == cluster) ++end;
  }
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(end));
}

bool WaitingRoom::may_wait(const World& world, const BreakProbe& cluster) {
  if (!driven_) driven_ = find_driven(world);
  return std::ranges::none_of(cluster.bodies(),
                              [&](const ProbeBody& body) { return driven_->contains(body.key); });
}

void WaitingRoom::add(World& world, const BreakProbe& cluster) {
  const std::size_t first = waiters_.size();
  for (const ProbeBody& body : cluster.bodies()) {
    if (body.inverse_mass <= 0) continue;
    waiters_.push_back({body.key, since_step(body.key, world.clock.step), next_cluster_});
  }
  pause_all(world, std::span(waiters_).subspan(first));
  ++next_cluster_;
  ++clusters_;
}

void WaitingRoom::end_step(World& world) {
  std::erase_if(queue_, [&](const Waiter& waiter) { return !world.actors.find(waiter.key); });
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (i == 0 || queue_[i].cluster != queue_[i - 1].cluster) ++clusters_;
  }
  pause_all(world, queue_);
  waiters_.insert(waiters_.end(), queue_.begin(), queue_.end());
  queue_.clear();
  std::ranges::sort(waiters_, {}, &Waiter::key);
  hold_what_hits(world);
  last_ = std::exchange(waiters_, {});
}

void WaitingRoom::hold_what_hits(World& world) {
  if (waiters_.empty()) return;
  if (!driven_) driven_ = find_driven(world);
  std::map<std::uint32_t, Waiter> waits;
  std::vector<BodyId> layer;
  const auto begin_to_wait = [&](const Waiter& waiter) {
    if (!waits.emplace(waiter.key, waiter).second) return;
    layer.push_back(world.actors.find(waiter.key)->body);
  };
  for (const Waiter& waiter : waiters_) begin_to_wait(waiter);
  const BodyStates states = world.physics->states();
  while (!layer.empty()) {
    const std::vector<Touch> touches = world.physics->touches(std::exchange(layer, {}));
    for (const Touch& touch : touches) {
      const bool a_waits = waits.contains(touch.body_tag_a);
      const std::uint32_t other_key = a_waits ? touch.body_tag_b : touch.body_tag_a;
      const auto waiter = waits.find(a_waits ? touch.body_tag_a : touch.body_tag_b);
      const Actor* other = world.actors.find(other_key);
      if (waiter == waits.end() || !other || other->is_static || waits.contains(other_key) ||
          driven_->contains(other_key))
        continue;
      const Vec3 to_other_W = a_waits ? touch.normal_W : Vec3(-touch.normal_W);
      if (!runs_into(world, states[other->body], a_waits ? touch.arm_b_W : touch.arm_a_W,
                     to_other_W, touch.separation_m))
        continue;
      Waiter joins = waiter->second;
      joins.key = other_key;
      begin_to_wait(joins);
    }
  }
  if (waits.size() == waiters_.size()) return;
  waiters_.clear();
  for (const auto& [key, waiter] : waits) waiters_.push_back(waiter);
  pause_all(world, waiters_);
}

std::uint64_t WaitingRoom::since_step(std::uint32_t key, std::uint64_t otherwise) const {
  const auto it = std::ranges::lower_bound(last_, key, {}, &Waiter::key);
  return it != last_.end() && it->key == key ? it->since_step : otherwise;
}

}  // namespace sunder
