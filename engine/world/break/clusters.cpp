#include "engine/world/break/clusters.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/froude.h"
#include "engine/base/rotation.h"
#include "engine/world/break/joint_graph.h"

namespace sunder {
namespace {

// Of a cluster, those nearest to the approach; fewer where what approaches cannot break itself, and
// an impact can only be passed on.
constexpr std::size_t kMostBodies = 32, kMostPassingOn = 12;

/// The approaches between two bodies as one.
struct Seed {
  std::uint32_t a = 0, b = 0;
  double energy_J = 0;
  std::uint64_t since_step = 0;  ///< It waits since then.
};

/// Pieces that came off in this step do not break again in it; what stands may be hit by others.
bool may_break(const World& world, const Actor* actor, double energy_J) {
  if (!actor || energy_J <= actor->least_of_all_J()) return false;
  return actor->is_static || actor->born_step != world.clock.step + 1;
}

/// Approaches with energy enough to break something in the world, in the order of find_clusters().
std::vector<Seed> find_seeds(const World& world, const WaitingRoom& waiting,
                             const JointGraph& joints) {
  double least_J = std::numeric_limits<double>::infinity();
  for (const Actor& actor : world.actors) {
    least_J = std::min(least_J, actor.least_of_all_J());
  }
  if (least_J == std::numeric_limits<double>::infinity()) return {};
  std::vector<Seed> pairs;
  for (const Approach& approach : world.physics->approaches()) {
    pairs.push_back({approach.body_tag_a, approach.body_tag_b, joints.closing_energy_J(approach)});
  }
  std::ranges::stable_sort(pairs, {}, [](const Seed& seed) { return std::pair(seed.a, seed.b); });
  std::vector<Seed> seeds;
  for (std::size_t i = 0, end = 0; i < pairs.size(); i = end) {
    Seed seed = pairs[i];
    for (end = i + 1; end < pairs.size() && pairs[end].a == seed.a && pairs[end].b == seed.b; ++end)
      seed.energy_J += pairs[end].energy_J;
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
  bool holds(std::uint32_t place) const { return all_[place].cluster == clusters_; }
  /// Moving bodies are in one cluster at most.
  void take(std::uint32_t place) { all_[place].taken = true; }
  bool taken(std::uint32_t place) const { return all_[place].taken; }
  /// In the cluster under way.
  void number(std::uint32_t place, std::uint32_t index) { all_[place].index = index; }
  std::uint32_t index(std::uint32_t place) const { return all_[place].index; }

 private:
  struct Member {
    std::uint32_t cluster = 0;  ///< The last that saw it.
    std::uint32_t index = 0;    ///< In that.
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
      : world_(world), states_(world.physics->states()), joints_(joints), members_(members) {
    members_.begin_cluster();
  }

  /// False if one of the seed's bodies is in a cluster already.
  bool start(const Seed& seed) {
    const std::uint32_t ends[] = {members_.place(seed.a), members_.place(seed.b)};
    bool direct = false;
    for (const std::uint32_t place : ends) {
      const Actor* actor = members_.actor(place);
      if (actor && !actor->is_static && members_.taken(place)) return false;
      direct |= may_break(world_, actor, seed.energy_J);
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
      std::pair last(kNobodyKey, kNobodyKey);
      for (const Touch& touch : world_.physics->touches(layer)) {
        const std::pair pair(touch.body_tag_a, touch.body_tag_b);
        if (std::exchange(last, pair) == pair) continue;  // another point of the same contact
        add(members_.place(pair.first));
        add(members_.place(pair.second));
      }
    }
  }

  /// Bodies by key, and the contacts among them.
  BreakProbe probe() {
    std::ranges::sort(places_);
    std::vector<ProbeBody> bodies;
    bodies.reserve(places_.size());
    for (const std::uint32_t place : places_) {
      members_.number(place, static_cast<std::uint32_t>(bodies.size()));
      bodies.push_back(describe(place));
    }
    const double horizon_s = world_.clock.horizon_s();
    const double still_m_s = FroudeScale(world_.scene.gravity_W).still_m_s(world_.clock.dt_s);
    std::vector<BodyId> moving;
    for (const std::uint32_t place : moving_) moving.push_back(members_.actor(place)->body);
    const std::vector<Touch> touches = world_.physics->touches(moving);
    std::vector<ProbeContact> contacts;
    contacts.reserve(touches.size());
    for (const Touch& touch : touches) {
      const std::uint32_t a = members_.place(touch.body_tag_a),
                          b = members_.place(touch.body_tag_b);
      if (!members_.holds(a) || !members_.holds(b)) {
        ProbeBody& inside = bodies[members_.index(members_.holds(a) ? a : b)];
        inside.leans |= touch.separation_m <= still_m_s * horizon_s;
        continue;
      }
      contacts.push_back({members_.index(a), members_.index(b), touch.shape_tag_a,
                          touch.shape_tag_b, touch.arm_a_W, touch.arm_b_W, touch.normal_W,
                          touch.separation_m});
    }
    std::vector<ProbeJoint> joints;
    for (const std::uint32_t joint : joints_of_cluster()) {
      link(world_.joints.live()[joint], bodies, contacts, joints);
    }
    return BreakProbe(std::move(bodies), std::move(contacts), horizon_s, still_m_s,
                      world_.scene.gravity_W, std::move(joints));
  }

  bool could_break(double energy_J) const {
    return std::ranges::any_of(places_, [&](std::uint32_t place) {
      return may_break(world_, members_.actor(place), energy_J);
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

  ProbeBody describe(std::uint32_t place) const {
    ProbeBody body;
    const Actor* actor = members_.actor(place);
    body.key = actor ? actor->key : kGroundKey;
    if (!actor) return body;
    body.least_J = actor->least_of_all_J();
    body.least_Ns = std::isfinite(actor->stress.least_J) ? 0 : actor->least_Ns;
    body.breakable = may_break(world_, actor, std::numeric_limits<double>::max());
    const BodyState state = states_[actor->body];
    body.position_W = state.X_WB.position;
    if (actor->is_static) return body;
    const Mat3 rotation = state.X_WB.rotation.toRotationMatrix();
    body.inverse_mass = 1 / actor->weight.mass_kg;
    body.inverse_inertia_W = rotation * actor->weight.inertia_R.inverse() * rotation.transpose();
    body.velocity_W = state.velocity_W;
    body.angular_velocity_W = state.angular_velocity_W;
    return body;
  }

  /// By place in Joints::live(), ascending.
  std::vector<std::uint32_t> joints_of_cluster() const {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t place : moving_) {
      for (const JointGraph::End& end : joints_.of(members_.actor(place)->key)) {
        all.push_back(end.joint);
      }
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Where a joint holds a body; anchors in W at the world's end.
  Vec3 anchor_W(const Joints::End& end) const {
    const Actor* actor = world_.actors.find(end.key);
    return actor ? rest_pose(*actor, states_[actor->body].X_WB) * end.anchor_R : end.anchor_R;
  }

  /// Adds a joint to what it is to a probe; or, if it leads out of the cluster, leans on that. A
  /// hinge of this very step is none: what made it has it flow before it bears anything.
  void link(const Joints::Live& joint, std::vector<ProbeBody>& bodies,
            std::vector<ProbeContact>& contacts, std::vector<ProbeJoint>& joints) const {
    if (joint.hinge && joint.hinge->flowed_step == world_.clock.step) return;
    const std::uint32_t a = members_.place(joint.a.key), b = members_.place(joint.b.key);
    if (!members_.holds(a) || !members_.holds(b)) {
      bodies[members_.index(members_.holds(a) ? a : b)].leans = true;
      return;
    }
    const Vec3 at_a_W = anchor_W(joint.a), at_b_W = anchor_W(joint.b);
    ProbeJoint link{joint.desc.kind, members_.index(a), members_.index(b)};
    link.arm_a_W = at_a_W - bodies[link.a].position_W;
    link.arm_b_W = at_b_W - bodies[link.b].position_W;
    if (joint.desc.kind == JointKind::kRope) {
      const double length_m = (at_a_W - at_b_W).norm();
      ProbeContact rope{link.a, link.b};
      rope.arm_a_W = link.arm_a_W, rope.arm_b_W = link.arm_b_W;
      if (length_m > 0) rope.normal_W = (at_a_W - at_b_W) / length_m;
      rope.separation_m = joint.desc.length_m - length_m;
      rope.rope = true;
      contacts.push_back(rope);
      return;
    }
    if (const Actor* actor = members_.actor(a)) {
      link.axis_W = states_[actor->body].X_WB.rotation * joint.desc.axis_a_R;
    } else {
      link.axis_W = joint.desc.axis_a_R;
    }
    joints.push_back(link);
  }

  const World& world_;
  const BodyStates states_;
  const JointGraph& joints_;
  Members& members_;
  std::vector<std::uint32_t> places_;  ///< Of this cluster's bodies, fixed ones too.
  std::vector<std::uint32_t> moving_;  ///< Nearest first.
  std::size_t most_ = kMostBodies;
};

}  // namespace

std::vector<BreakProbe> find_clusters(const World& world, const WaitingRoom& waiting) {
  const JointGraph joints(world);
  const std::vector<Seed> seeds = find_seeds(world, waiting, joints);
  std::vector<BreakProbe> clusters;
  if (seeds.empty()) return clusters;
  Members members(world);
  waiting.for_each([&](const Waiter& waiter) { members.take(members.place(waiter.key)); });
  for (const Seed& seed : seeds) {
    Reach reach(world, joints, members);
    if (!reach.start(seed)) continue;
    reach.grow();
    if (reach.could_break(seed.energy_J)) clusters.push_back(reach.probe());
  }
  return clusters;
}

void take_over(World& world, const BreakProbe& probe) {
  for (std::size_t b = 0; b < probe.bodies().size(); ++b) {
    const ProbeMotion& motion = probe.motions()[b];
    if (!motion.changed) continue;
    const BodyId body = world.actors.find(probe.bodies()[b].key)->body;
    BodyState state = world.physics->state(body);
    state.X_WB.position += motion.shift_W;
    state.X_WB.rotation = (rotation_by(motion.rotation_W) * state.X_WB.rotation).normalized();
    state.velocity_W = motion.velocity_W;
    state.angular_velocity_W = motion.angular_velocity_W;
    world.physics->set_state(body, state);
  }
}

}  // namespace sunder
