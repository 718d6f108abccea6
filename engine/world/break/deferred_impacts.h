// Deferred impacts: clusters that are paused at the time of an impact until a later step has the
// budget for it. Clusters that a moving kinematic body touches cannot be paused, as the body would
// run through them. Internal to engine/world.
//
// Read first: the functions, which are called in the order of their declarations.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "engine/model/impact_probe.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// A body of a deferred cluster.
struct DeferredBody {
  std::uint32_t key = 0;
  std::uint64_t since_step = 0;  ///< First step that deferred the body.
  std::uint64_t cluster = 0;     ///< Number of the cluster.
};

class DeferredImpacts {
 public:
  /// Begins a step: clusters deferred in the last one enter the queue, the longest deferred first.
  void begin_step(const WorldState& world);
  /// Removes the first clusters from the queue, so that they are probed again.
  void release_first();
  bool queue_empty() const { return queue_.empty(); }
  /// To be called when contacts have been found anew.
  void invalidate_driven() { driven_.reset(); }
  /// Returns true if no body of a cluster is in contact, direct or through others, with a moving
  /// kinematic body.
  bool may_defer(const WorldState& world, const ImpactProbe& cluster);
  /// Defers the bodies of a cluster, whose probe has ended by end_early(), to the next step.
  void add(WorldState& world, const ImpactProbe& cluster);
  /// Ends a step: clusters still in the queue stay deferred. Calls Physics::pause() for all bodies.
  void end_step(WorldState& world);

  /// Returns the first step that deferred a body; `otherwise` if the body was not deferred in the
  /// last step.
  std::uint64_t since_step(std::uint32_t key, std::uint64_t otherwise) const;
  /// Calls `visit` with each deferred body.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const DeferredBody& body : bodies_) visit(body);
    for (const DeferredBody& body : queue_) visit(body);
  }
  /// Number of deferred clusters, after end_step().
  std::uint32_t clusters() const { return clusters_; }

  static auto fields(auto& self) {
    return std::tie(self.last_step_, self.queue_, self.bodies_, self.driven_, self.next_cluster_,
                    self.clusters_);
  }

 private:
  /// Defers the bodies that would hit a deferred one in this step, directly or through others.
  void pause_bodies_that_hit(WorldState& world);

  std::vector<DeferredBody> last_step_;  ///< Deferred in the last step; ascending by key.
  std::vector<DeferredBody> queue_;   ///< Those of last_step_ not released yet, cluster by cluster.
  std::vector<DeferredBody> bodies_;  ///< Deferred in this step.
  /// Keys of moving kinematic bodies and all bodies connected to them by contacts; computed when
  /// first needed.
  std::optional<std::set<std::uint32_t>> driven_;
  std::uint64_t next_cluster_ = 0;
  std::uint32_t clusters_ = 0;
};

}  // namespace sunder
