#include "engine/world/break/clusters.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/break/cluster_probe.h"
#include "engine/world/break/joint_graph.h"

namespace sunder {
namespace {

// Of a cluster, those nearest to the approach; fewer where what approaches cannot break itself, and
// an impact can only be passed on.
constexpr std::size_t kMostBodies = 32, kMostPassingOn = 12;
constexpr double kMore = 2;  // impulse and speed of an approach, at most, once others have met

/// The approaches between two bodies as one.
struct Seed {
  std::uint32_t a = 0, b = 0;
  double energy_J = 0, impulse_Ns = 0, speed_m_s = 0;
  std::uint64_t since_step = 0;  ///< It waits since then.

  void add(double closing_J, double closing_m_s) {
    energy_J += closing_J;
    impulse_Ns += 2 * closing_J / closing_m_s;
    speed_m_s = std::max(speed_m_s, closing_m_s);
  }
};

/// Returns true if the impact that a seed passes on may break an actor.
bool may_break(const World& world, const Actor* actor, const Seed& seed) {
  return may_break(world, actor, seed.energy_J, kMore * seed.impulse_Ns, kMore * seed.speed_m_s);
}

/// Approaches with energy enough to break something in the world, in the order of find_clusters().
std::vector<Seed> find_seeds(const World& world, const WaitingRoom& waiting,
                             const JointGraph& joints, double least_J) {
  double least_of_all_J = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) {
    least_of_all_J = std::min(least_of_all_J, actor.least_of_all_J());
  }
  if (least_of_all_J == std::numeric_limits<double>::infinity()) return {};
  least_J = std::max(least_J, least_of_all_J);
  std::vector<Seed> pairs;
  for (const Approach& approach : world.physics->approaches()) {
    Seed& pair = pairs.emplace_back(Seed{approach.body_tag_a, approach.body_tag_b});
    pair.add(joints.closing_energy_J(approach), joints.closing_speed_m_s(approach));
  }
  std::ranges::stable_sort(pairs, {}, [](const Seed& seed) { return std::pair(seed.a, seed.b); });
  std::vector<Seed> seeds;
  for (std::size_t i = 0, end = 0; i < pairs.size(); i = end) {
    Seed seed = pairs[i];
    for (end = i + 1; end < pairs.size() && pairs[end].a == seed.a && pairs[end].b == seed.b; ++end)
      seed.add(pairs[end].energy_J, pairs[end].speed_m_s);
    if (seed.energy_J <= least_J) continue;
    seed.since_step = std::min(waiting.since_step(seed.a, world.clock.step),
                               waiting.since_step(seed.b, world.clock.step));
    seeds.push_back(seed);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) {
    return std::pair(x.since_step, -x.energy_J) < std::pair(y.since_step, -y.energy_J);
  });
  return seeds;
}

/// Which actors are in clusters. Actors are known by their place in the world; the ground comes
/// behind them all.
class Members {
 public:
  explicit Members(const World& world)
      : world_(world),
        place_of_key_(world.actors.next_key(), ground()),
        all_(world.actors.size() + 1) {
    for (std::uint32_t place = 0; place < ground(); ++place) {
      place_of_key_[world.actors[place].key] = place;
    }
  }

  std::uint32_t place(std::uint32_t key) const {
    return key < place_of_key_.size() ? place_of_key_[key] : ground();
  }
  /// Null for the ground.
  const Actor* actor(std::uint32_t place) const {
    return place < ground() ? &world_.actors[place] : nullptr;
  }
  void begin_cluster() { ++clusters_; }
  /// False if it was in this cluster already.
  bool add(std::uint32_t place) {
    return std::exchange(all_[place].cluster, clusters_) != clusters_;
  }
  /// Moving bodies are in one cluster at most.
  void take(std::uint32_t place) { all_[place].taken = true; }
  bool taken(std::uint32_t place) const { return all_[place].taken; }

 private:
  struct Member {
    std::uint32_t cluster = 0;  ///< The last that saw it.
    bool taken = false;
  };

  std::uint32_t ground() const { return static_cast<std::uint32_t>(world_.actors.size()); }

  const World& world_;
  std::vector<std::uint32_t> place_of_key_;
  std::vector<Member> all_;
  std::uint32_t clusters_ = 0;  ///< The number of the last.
};

/// Bodies reached from a seed, contact by contact and joint by joint.
class Reach {
 public:
  Reach(const World& world, const JointGraph& joints, Members& members)
      : world_(world), joints_(joints), members_(members) {
    members_.begin_cluster();
  }

  /// False if one of the seed's bodies is in a cluster already.
  bool start(const Seed& seed) {
    const std::uint32_t ends[] = {members_.place(seed.a), members_.place(seed.b)};
    bool direct = false;
    for (const std::uint32_t place : ends) {
      const Actor* actor = members_.actor(place);
      if (actor && !actor->is_static && members_.taken(place)) return false;
      direct |= may_break(world_, actor, seed);
    }
    most_ = direct ? kMostBodies : kMostPassingOn;
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
        for (const JointGraph::End& at : joints_.of(actor.key)) {
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
    if (moves && (moving_.size() >= most_ || members_.taken(place))) return;
    if (!members_.add(place)) return;
    places_.push_back(place);
    if (!moves) return;
    moving_.push_back(place);
    members_.take(place);
  }

  const World& world_;
  const JointGraph& joints_;
  Members& members_;
  std::vector<std::uint32_t> places_;  ///< Of this cluster's bodies, fixed ones too.
  std::vector<std::uint32_t> moving_;  ///< Nearest first.
  std::size_t most_ = kMostBodies;
};

}  // namespace

std::vector<BreakProbe> find_clusters(const World& world, const WaitingRoom& waiting,
                                      double least_J) {
  const JointGraph joints(world);
  const std::vector<Seed> seeds = find_seeds(world, waiting, joints, least_J);
  if (seeds.empty()) return {};
  std::vector<Cluster> clusters;
  Members members(world);
  waiting.for_each([&](const Waiter& waiter) { members.take(members.place(waiter.key)); });
  for (const Seed& seed : seeds) {
    Reach reach(world, joints, members);
    if (!reach.start(seed)) continue;
    reach.grow();
    if (reach.could_break(seed)) clusters.push_back(reach.cluster());
  }
  std::vector<std::optional<BreakProbe>> made(clusters.size());
  for_chunks(made.size(), 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) made[i] = make_probe(world, joints, clusters[i]);
  });
  std::vector<BreakProbe> probes;
  for (std::optional<BreakProbe>& probe : made) probes.push_back(std::move(*probe));
  return probes;
}

double take_over(World& world, const BreakProbe& probe) {
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
