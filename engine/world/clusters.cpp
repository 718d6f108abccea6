#include "engine/world/clusters.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace sunder {
namespace {

// Of a cluster, those nearest to the approach; fewer where what approaches cannot break itself, and
// a blow can only be passed on.
constexpr std::size_t kMostBodies = 32, kMostPassingOn = 12;

/// The approaches between two bodies as one.
struct Seed {
  std::uint32_t a = 0, b = 0;
  double energy_J = 0;
  std::uint64_t since_step = 0;  ///< It waits since then.
};

std::uint64_t waits_since(const World& world, std::uint32_t key) {
  const auto it = std::ranges::lower_bound(world.waiters, key, {}, &Waiter::key);
  return it != world.waiters.end() && it->key == key ? it->since_step : world.step;
}

/// Pieces that came off in this step do not break again in it; what stands may be hit by others.
bool may_break(const World& world, const Actor* actor, double energy_J) {
  if (!actor || energy_J <= actor->least_J) return false;
  return actor->is_static || actor->born_step != world.step + 1;
}

/// Approaches with energy enough to break something in the world, in the order of find_clusters().
std::vector<Seed> find_seeds(World& world) {
  double least_J = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) least_J = std::min(least_J, actor.least_J);
  if (least_J == std::numeric_limits<double>::infinity()) return {};
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> energy_J;
  for (const Approach& approach : world.physics->approaches()) {
    energy_J[{approach.body_tag_a, approach.body_tag_b}] +=
        0.5 * approach.effective_mass_kg * approach.speed_m_s * approach.speed_m_s;
  }
  std::vector<Seed> seeds;
  for (const auto& [keys, energy] : energy_J) {
    if (energy <= least_J) continue;
    const std::uint64_t since =
        std::min(waits_since(world, keys.first), waits_since(world, keys.second));
    seeds.push_back({keys.first, keys.second, energy, since});
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) {
    return std::pair(x.since_step, -x.energy_J) < std::pair(y.since_step, -y.energy_J);
  });
  return seeds;
}

/// Bodies reached from a seed, contact by contact.
class Reach {
 public:
  Reach(World& world, std::set<std::uint32_t>& taken) : world_(world), taken_(taken) {}

  /// False if one of the seed's bodies is in a cluster already.
  bool start(const Seed& seed) {
    for (const std::uint32_t key : {seed.a, seed.b}) {
      const Actor* actor = world_.find(key);
      if (actor && !actor->is_static && taken_.contains(key)) return false;
    }
    const bool direct = may_break(world_, world_.find(seed.a), seed.energy_J) ||
                        may_break(world_, world_.find(seed.b), seed.energy_J);
    most_ = direct ? kMostBodies : kMostPassingOn;
    add(seed.a);
    add(seed.b);
    return true;
  }

  void grow() {
    for (std::size_t done = 0; done < moving_.size() && moving_.size() < most_;) {
      std::vector<BodyId> layer;
      for (; done < moving_.size(); ++done) layer.push_back(world_.find(moving_[done])->body);
      for (const Touch& touch : world_.physics->touches(layer)) {
        add(touch.body_tag_a);
        add(touch.body_tag_b);
      }
    }
  }

  /// Bodies by key, and the contacts among them.
  BreakProbe probe() const {
    std::vector<ProbeBody> bodies;
    std::map<std::uint32_t, std::uint32_t> index;
    for (const std::uint32_t key : keys_) {
      index[key] = static_cast<std::uint32_t>(bodies.size());
      bodies.push_back(describe(key));
    }
    std::vector<BodyId> moving;
    for (const std::uint32_t key : moving_) moving.push_back(world_.find(key)->body);
    std::vector<ProbeContact> contacts;
    for (const Touch& touch : world_.physics->touches(moving)) {
      const auto a = index.find(touch.body_tag_a), b = index.find(touch.body_tag_b);
      if (a == index.end() || b == index.end()) continue;
      contacts.push_back({a->second, b->second, touch.shape_tag_a, touch.shape_tag_b, touch.arm_a_W,
                          touch.arm_b_W, touch.normal_W, touch.separation_m});
    }
    return BreakProbe(std::move(bodies), std::move(contacts), world_.horizon_s());
  }

  bool could_break(double energy_J) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](std::uint32_t key) {
      return may_break(world_, world_.find(key), energy_J);
    });
  }

 private:
  void add(std::uint32_t key) {
    const Actor* actor = world_.find(key);
    const bool moves = actor && !actor->is_static;
    if (moves && moving_.size() >= most_) return;
    if (moves && taken_.contains(key)) return;
    if (!keys_.insert(key).second || !moves) return;
    moving_.push_back(key);
    taken_.insert(key);
  }

  ProbeBody describe(std::uint32_t key) const {
    ProbeBody body;
    body.key = key;
    const Actor* actor = world_.find(key);
    if (!actor) return body;  // the ground
    body.least_J = actor->least_J;
    body.least_Ns = actor->least_Ns;
    body.breakable = may_break(world_, actor, std::numeric_limits<double>::max());
    if (actor->is_static) return body;
    const BodyState state = world_.physics->state(actor->body);
    const Mat3 rotation = state.X_WB.rotation.toRotationMatrix();
    body.inverse_mass = 1 / actor->weight.mass_kg;
    body.inverse_inertia_W = rotation * actor->weight.inertia_R.inverse() * rotation.transpose();
    body.velocity_W = state.velocity_W;
    body.angular_velocity_W = state.angular_velocity_W;
    return body;
  }

  World& world_;
  std::set<std::uint32_t>& taken_;     ///< Moving bodies of all clusters.
  std::set<std::uint32_t> keys_;       ///< Of this cluster, held ones too.
  std::vector<std::uint32_t> moving_;  ///< Nearest first.
  std::size_t most_ = kMostBodies;
};

}  // namespace

std::vector<BreakProbe> find_clusters(World& world, const std::vector<Waiter>& left_out) {
  std::vector<BreakProbe> clusters;
  std::set<std::uint32_t> taken;
  for (const Waiter& waiter : left_out) taken.insert(waiter.key);
  for (const Seed& seed : find_seeds(world)) {
    Reach reach(world, taken);
    if (!reach.start(seed)) continue;
    reach.grow();
    if (reach.could_break(seed.energy_J)) clusters.push_back(reach.probe());
  }
  return clusters;
}

}  // namespace sunder
