#include "engine/world/break/waiting_room.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

namespace sunder {
namespace {

constexpr int kAdmitted = 3;  // clusters that have waited and are looked at in one round

void pause_all(World& world, std::span<const Waiter> waiters) {
  std::vector<BodyId> bodies;
  for (const Waiter& waiter : waiters) bodies.push_back(world.actors.find(waiter.key)->body);
  world.physics->pause(bodies);
}

}  // namespace

void WaitingRoom::begin_step(const Actors& actors) {
  clusters_ = 0;
  waiters_.clear();
  queue_ = last_;
  std::erase_if(queue_, [&](const Waiter& waiter) { return !actors.find(waiter.key); });
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
  last_ = std::exchange(waiters_, {});
}

std::uint64_t WaitingRoom::since_step(std::uint32_t key, std::uint64_t otherwise) const {
  const auto it = std::ranges::lower_bound(last_, key, {}, &Waiter::key);
  return it != last_.end() && it->key == key ? it->since_step : otherwise;
}

}  // namespace sunder
