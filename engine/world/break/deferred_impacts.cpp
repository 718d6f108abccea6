#include "engine/world/break/deferred_impacts.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "engine/world/tuning.h"

namespace sunder {
namespace {

void pause_all(WorldState& world, std::span<const DeferredBody> deferred) {
  std::vector<BodyId> bodies;
  for (const DeferredBody& body : deferred) bodies.push_back(world.actors.find(body.key)->body);
  world.physics->pause(bodies);
}

bool moves(const BodyState& state) {
  return !state.velocity_W.isZero(0) || !state.angular_velocity_W.isZero(0);
}

std::set<std::uint32_t> find_driven(const WorldState& world) {
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
bool will_hit(const WorldState& world, const BodyState& other, const Vec3& arm_W,
              const Vec3& to_other_W, double separation_m) {
  const Vec3 velocity_W = other.velocity_W + other.angular_velocity_W.cross(arm_W);
  const double closing_m_s = -velocity_W.dot(to_other_W);
  return closing_m_s > kPauseSpeed_m_s && closing_m_s * world.clock.dt_s > separation_m;
}

}  // namespace

void DeferredImpacts::begin_step(const WorldState& world) {
  clusters_ = 0;
  bodies_.clear();
  invalidate_driven();
  queue_ = last_step_;
  std::erase_if(queue_, [&](const DeferredBody& body) { return !world.actors.find(body.key); });
  if (queue_.empty()) return;
  driven_ = find_driven(world);
  std::set<std::uint64_t> leave;
  for (const DeferredBody& body : queue_)
    if (driven_->contains(body.key)) leave.insert(body.cluster);
  std::erase_if(queue_, [&](const DeferredBody& body) { return leave.contains(body.cluster); });
  std::ranges::sort(queue_, {}, [](const DeferredBody& body) {
    return std::tuple(body.since_step, body.cluster, body.key);
  });
}

void DeferredImpacts::release_first() {
  std::size_t end = 0;
  for (int clusters = 0; clusters < kReleasedClustersPerRound && end < queue_.size(); ++clusters) {
    const std::uint64_t cluster = queue_[end].cluster;
    while (end < queue_.size() && queue_[end].cluster == cluster) ++end;
  }
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(end));
}

bool DeferredImpacts::may_defer(const WorldState& world, const ImpactProbe& cluster) {
  if (!driven_) driven_ = find_driven(world);
  return std::ranges::none_of(cluster.bodies(),
                              [&](const ProbeBody& body) { return driven_->contains(body.key); });
}

void DeferredImpacts::add(WorldState& world, const ImpactProbe& cluster) {
  const std::size_t first = bodies_.size();
  for (const ProbeBody& body : cluster.bodies()) {
    if (body.inverse_mass <= 0) continue;
    bodies_.push_back({body.key, since_step(body.key, world.clock.step), next_cluster_});
  }
  pause_all(world, std::span(bodies_).subspan(first));
  ++next_cluster_;
  ++clusters_;
}

void DeferredImpacts::end_step(WorldState& world) {
  std::erase_if(queue_, [&](const DeferredBody& body) { return !world.actors.find(body.key); });
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (i == 0 || queue_[i].cluster != queue_[i - 1].cluster) ++clusters_;
  }
  pause_all(world, queue_);
  bodies_.insert(bodies_.end(), queue_.begin(), queue_.end());
  queue_.clear();
  std::ranges::sort(bodies_, {}, &DeferredBody::key);
  pause_bodies_that_hit(world);
  last_step_ = std::exchange(bodies_, {});
}

void DeferredImpacts::pause_bodies_that_hit(WorldState& world) {
  if (bodies_.empty()) return;
  if (!driven_) driven_ = find_driven(world);
  std::map<std::uint32_t, DeferredBody> deferred;
  std::vector<BodyId> layer;
  const auto defer_body = [&](const DeferredBody& body) {
    if (!deferred.emplace(body.key, body).second) return;
    layer.push_back(world.actors.find(body.key)->body);
  };
  for (const DeferredBody& body : bodies_) defer_body(body);
  const BodyStates states = world.physics->states();
  while (!layer.empty()) {
    const std::vector<Touch> touches = world.physics->touches(std::exchange(layer, {}));
    for (const Touch& touch : touches) {
      const bool a_is_deferred = deferred.contains(touch.body_tag_a);
      const std::uint32_t other_key = a_is_deferred ? touch.body_tag_b : touch.body_tag_a;
      const auto body = deferred.find(a_is_deferred ? touch.body_tag_a : touch.body_tag_b);
      const Actor* other = world.actors.find(other_key);
      if (body == deferred.end() || !other || other->is_static || deferred.contains(other_key) ||
          driven_->contains(other_key))
        continue;
      const Vec3 to_other_W = a_is_deferred ? touch.normal_W : Vec3(-touch.normal_W);
      if (!will_hit(world, states[other->body], a_is_deferred ? touch.arm_b_W : touch.arm_a_W,
                    to_other_W, touch.separation_m))
        continue;
      DeferredBody hitting = body->second;
      hitting.key = other_key;
      defer_body(hitting);
    }
  }
  if (deferred.size() == bodies_.size()) return;
  bodies_.clear();
  for (const auto& [key, body] : deferred) bodies_.push_back(body);
  pause_all(world, bodies_);
}

std::uint64_t DeferredImpacts::since_step(std::uint32_t key, std::uint64_t otherwise) const {
  const auto it = std::ranges::lower_bound(last_step_, key, {}, &DeferredBody::key);
  return it != last_step_.end() && it->key == key ? it->since_step : otherwise;
}

}  // namespace sunder
