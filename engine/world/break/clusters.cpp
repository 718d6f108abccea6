#include "engine/world/break/clusters.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/break/cluster_probe.h"
#include "engine/world/break/joint_graph.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// All speculative contacts between two bodies, from which a cluster grows.
struct Seed {
  std::uint32_t a = 0, b = 0;
  double energy_J = 0, impulse_Ns = 0, speed_m_s = 0;
  std::uint64_t since_step = 0;  ///< First step that deferred one of the bodies.

  void add(double closing_J, double closing_m_s) {
    energy_J += closing_J;
    impulse_Ns += 2 * closing_J / closing_m_s;
    speed_m_s = std::max(speed_m_s, closing_m_s);
  }
};

/// Returns true if the impact of a seed, direct or passed on, may break an actor.
bool may_break(const WorldState& world, const Actor* actor, const Seed& seed) {
  return may_break(world, actor, seed.energy_J, kMaxImpulseGain * seed.impulse_Ns,
                   kMaxImpulseGain * seed.speed_m_s);
}

/// Returns the most moving bodies of a cluster, the nearest to the seed first; `direct`: a body of
/// the seed may break, or else the impact can only be passed on.
std::size_t most_bodies(const WorldState& world, bool direct) {
  const std::size_t most = world.scene.limits.cluster_bodies;
  return direct ? most : std::max<std::size_t>(2, most * 3 / 8);
}

/// Returns the seeds with energy enough to break an actor, in the order of find_clusters(). Counts
/// seeds that may break an actor of theirs, and have no more than `min_energy_J`.
std::vector<Seed> find_seeds(const WorldState& world, const DeferredImpacts& deferred,
                             const JointGraph& joints, double min_energy_J, LimitsHit& limits) {
  double least_of_all_J = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) {
    least_of_all_J = std::min(least_of_all_J, actor.least_of_all_J());
  }
  if (least_of_all_J == std::numeric_limits<double>::infinity()) return {};
  const auto is_passed_over = [&](const Seed& seed) {
    return min_energy_J > least_of_all_J && seed.energy_J > least_of_all_J &&
           (may_break(world, world.actors.find(seed.a), seed) ||
            may_break(world, world.actors.find(seed.b), seed));
  };
  std::vector<Seed> pairs;
  for (const SpeculativeContact& approach : world.physics->speculative_contacts()) {
    Seed& pair = pairs.emplace_back(Seed{approach.body_tag_a, approach.body_tag_b});
    pair.add(joints.closing_energy_J(approach), joints.closing_speed_m_s(approach));
  }
  std::ranges::stable_sort(pairs, {}, [](const Seed& seed) { return std::pair(seed.a, seed.b); });
  std::vector<Seed> seeds;
  for (std::size_t i = 0, end = 0; i < pairs.size(); i = end) {
    Seed seed = pairs[i];
    for (end = i + 1; end < pairs.size() && pairs[end].a == seed.a && pairs[end].b == seed.b; ++end)
      seed.add(pairs[end].energy_J, pairs[end].speed_m_s);
    if (seed.energy_J <= std::max(min_energy_J, least_of_all_J)) {
      if (is_passed_over(seed)) ++limits[Limit::kPartsAFrame];
      continue;
    }
    seed.since_step = std::min(deferred.since_step(seed.a, world.clock.step),
                               deferred.since_step(seed.b, world.clock.step));
    seeds.push_back(seed);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) {
    return std::pair(x.since_step, -x.energy_J) < std::pair(y.since_step, -y.energy_J);
  });
  return seeds;
}

/// Membership of actors in clusters. Actors are given by their index in WorldState::actors; the
/// ground has the index after the last.
class ClusterMembership {
 public:
  explicit ClusterMembership(const WorldState& world)
      : world_(world),
        first_key_(world.actors.size() > 0 ? world.actors[0].key : world.actors.next_key()),
        place_of_key_(world.actors.next_key() - first_key_, ground()),
        all_(world.actors.size() + 1) {
    for (std::uint32_t place = 0; place < ground(); ++place) {
      place_of_key_[world.actors[place].key - first_key_] = place;
    }
  }

  std::uint32_t place(std::uint32_t key) const {
    const std::uint32_t offset = key - first_key_;  // wraps for keys that are gone
    return offset < place_of_key_.size() ? place_of_key_[offset] : ground();
  }
  /// Returns the actor at an index; null for the ground.
  const Actor* actor(std::uint32_t place) const {
    return place < ground() ? &world_.actors[place] : nullptr;
  }
  void begin_cluster() { ++clusters_; }
  /// Adds an actor to the current cluster; returns false if it was in the cluster already.
  bool add(std::uint32_t place) {
    return std::exchange(all_[place].cluster, clusters_) != clusters_;
  }
  /// Marks a moving body as used, so that it is in one cluster at most.
  void claim(std::uint32_t place) { all_[place].is_claimed = true; }
  bool is_claimed(std::uint32_t place) const { return all_[place].is_claimed; }

 private:
  struct Member {
    std::uint32_t cluster = 0;  ///< Last cluster that the actor was added to.
    bool is_claimed = false;
  };

  std::uint32_t ground() const { return static_cast<std::uint32_t>(world_.actors.size()); }

  const WorldState& world_;
  std::uint32_t first_key_;                  ///< Least key of an actor.
  std::vector<std::uint32_t> place_of_key_;  ///< By key, from the least on.
  std::vector<Member> all_;
  std::uint32_t clusters_ = 0;  ///< Number of clusters so far.
};

/// Breadth-first search of the cluster of a seed along contacts and joints.
class ClusterSearch {
 public:
  ClusterSearch(const WorldState& world, const JointGraph& joints, ClusterMembership& members)
      : world_(world), joints_(joints), members_(members) {
    members_.begin_cluster();
  }

  /// Begins with a seed; returns false if a moving body of the seed is in a cluster already.
  bool start(const Seed& seed) {
    const std::uint32_t ends[] = {members_.place(seed.a), members_.place(seed.b)};
    bool direct = false;
    for (const std::uint32_t place : ends) {
      const Actor* actor = members_.actor(place);
      if (actor && !actor->is_static && members_.is_claimed(place)) return false;
      direct |= may_break(world_, actor, seed);
    }
    if (!direct && !world_.scene.limits.passed_impacts) return false;
    most_ = most_bodies(world_, direct);
    for (const std::uint32_t place : ends) add(place);
    return true;
  }

  void grow() {
    std::vector<BodyId> layer;
    for (std::size_t done = 0; done < moving_.size() && moving_.size() < most_;) {
      layer.clear();
      for (const std::size_t end = moving_.size(); done < end; ++done) {
        const Actor& actor = *members_.actor(moving_[done]);
        layer.push_back(actor.body);
        for (const JointGraph::End& at : joints_.ends_at(actor.key)) {
          const Joints::Live& joint = world_.joints.live()[at.joint];
          add(members_.place(joint.a.key));
          add(members_.place(joint.b.key));
        }
      }
      for (const TouchingBodies& touch : world_.physics->touching(layer)) {
        add(members_.place(touch.tag_a));
        add(members_.place(touch.tag_b));
      }
    }
  }

  /// Returns true if the cluster has as many moving bodies as it may have.
  bool is_full() const { return moving_.size() >= most_; }

  Cluster cluster() {
    std::ranges::sort(places_);
    Cluster cluster;
    for (const std::uint32_t place : places_) cluster.push_back(members_.actor(place));
    return cluster;
  }

  bool could_break(const Seed& seed) const {
    return std::ranges::any_of(places_, [&](std::uint32_t place) {
      return may_break(world_, members_.actor(place), seed);
    });
  }

 private:
  void add(std::uint32_t place) {
    const Actor* actor = members_.actor(place);
    const bool moves = actor && !actor->is_static;
    if (moves && (moving_.size() >= most_ || members_.is_claimed(place))) return;
    if (!members_.add(place)) return;
    places_.push_back(place);
    if (!moves) return;
    moving_.push_back(place);
    members_.claim(place);
  }

  const WorldState& world_;
  const JointGraph& joints_;
  ClusterMembership& members_;
  std::vector<std::uint32_t> places_;  ///< All bodies of the cluster, static ones included.
  std::vector<std::uint32_t> moving_;  ///< Moving bodies of the cluster, nearest first.
  std::size_t most_ = 0;
};

}  // namespace

std::vector<std::unique_ptr<ImpactProbe>> find_clusters(const WorldState& world,
                                                        const DeferredImpacts& deferred,
                                                        double min_energy_J, LimitsHit& limits) {
  const JointGraph joints(world);
  const std::vector<Seed> seeds = find_seeds(world, deferred, joints, min_energy_J, limits);
  if (seeds.empty()) return {};
  std::vector<Cluster> clusters;
  ClusterMembership members(world);
  deferred.for_each([&](const DeferredBody& body) { members.claim(members.place(body.key)); });
  for (const Seed& seed : seeds) {
    ClusterSearch search(world, joints, members);
    if (!search.start(seed)) continue;
    search.grow();
    if (!search.could_break(seed)) continue;
    if (search.is_full()) ++limits[Limit::kClusterBodies];
    clusters.push_back(search.cluster());
  }
  std::vector<std::unique_ptr<ImpactProbe>> probes(clusters.size());
  for_chunks(probes.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) probes[i] = make_probe(world, joints, clusters[i]);
  });
  return probes;
}

double apply_motion(WorldState& world, const ImpactProbe& probe) {
  double gain_J = 0;
  for (std::size_t b = 0; b < probe.bodies().size(); ++b) {
    const ProbeMotion& motion = probe.motions()[b];
    if (!motion.changed) continue;
    const Actor& actor = *world.actors.find(probe.bodies()[b].key);
    BodyState state = world.physics->state(actor.body);
    state.X_WB.position += motion.shift_W;
    state.X_WB.rotation = (rotation_by(motion.rotation_W) * state.X_WB.rotation).normalized();
    state.velocity_W = motion.velocity_W;
    state.angular_velocity_W = motion.angular_velocity_W;
    gain_J += move_actor(world, actor, state);
  }
  return gain_J;
}

}  // namespace sunder
