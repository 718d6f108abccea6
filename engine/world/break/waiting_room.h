// Clusters that sit steps out, at the place of the impact, until it can be decided. What a moved
// body drives cannot: it would be run over. Internal to engine/world.
//
// Read first: the order of calls, which is that of the functions.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "engine/world/actors/world.h"
#include "engine/world/break/break_probe.h"

namespace sunder {

/// A body that waits.
struct Waiter {
  std::uint32_t key = 0;
  std::uint64_t since_step = 0;
  std::uint64_t cluster = 0;  ///< Waits together with the others of this number.
};

class WaitingRoom {
 public:
  /// A step begins: who waited in the last one queues, the longest waiting first.
  void begin_step(const World& world);
  /// Lets the first clusters out of the queue: they are looked at again.
  void admit();
  bool queue_empty() const { return queue_.empty(); }
  /// Contacts have been found anew.
  void forget_driven() { driven_.reset(); }
  /// Whether none of a cluster is driven by what is moved.
  bool may_wait(const World& world, const BreakProbe& cluster);
  /// The bodies of a cluster that has ended by pause() wait until the next step.
  void add(World& world, const BreakProbe& cluster);
  /// Who is in the queue still waits on. Physics::pause() for all.
  void end_step(World& world);

  /// Since when a body waits that did in the last step; `otherwise`, if it did not.
  std::uint64_t since_step(std::uint32_t key, std::uint64_t otherwise) const;
  /// Calls `visit` with those who wait now.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const Waiter& waiter : waiters_) visit(waiter);
    for (const Waiter& waiter : queue_) visit(waiter);
  }
  /// How many wait, after end_step().
  std::uint32_t clusters() const { return clusters_; }

 private:
  /// Adds the bodies that would hit a waiting one in this step, directly or through others.
  void hold_what_hits(World& world);

  std::vector<Waiter> last_;     ///< Of the last step; ascending by key.
  std::vector<Waiter> queue_;    ///< Of those, who is not admitted yet; cluster by cluster.
  std::vector<Waiter> waiters_;  ///< Since this step.
  /// Keys of what is moved and all that it reaches by touch, if anybody has asked.
  std::optional<std::set<std::uint32_t>> driven_;
  std::uint64_t next_cluster_ = 0;
  std::uint32_t clusters_ = 0;
};

}  // namespace sunder
