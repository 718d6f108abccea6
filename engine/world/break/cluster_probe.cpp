#include "engine/world/break/cluster_probe.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/base/froude.h"
#include "engine/base/hash.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

constexpr std::uint32_t kOutside = 0xffffffff;

/// Collects the bodies, contacts and joints of a cluster.
class ProbeBuilder {
 public:
  ProbeBuilder(const WorldState& world, const JointGraph& joints, const Cluster& cluster)
      : world_(world), states_(world.physics->states()), joints_(joints), cluster_(cluster) {
    bodies_.reserve(cluster.size());
    for (const Actor* actor : cluster) {
      keys_.push_back(actor ? actor->key : kGroundKey);
      bodies_.push_back(make_body(actor));
    }
  }

  std::unique_ptr<ImpactProbe> probe() {
    const double horizon_s = world_.clock.horizon_s();
    const double rest_speed_m_s =
        FroudeScale(world_.scene.gravity_W).rest_speed_m_s(world_.clock.dt_s);
    add_contacts(rest_speed_m_s * horizon_s);
    for (const std::uint32_t joint : joints_of_cluster()) add_joint(world_.joints.live()[joint]);
    return world_.physics->probe({std::move(bodies_), std::move(contacts_),
                                  std::move(probe_joints_), horizon_s, rest_speed_m_s,
                                  world_.scene.gravity_W, world_.scene.limits.probe_events});
  }

 private:
  std::uint32_t index_of(std::uint32_t key) const {
    const auto it = std::ranges::lower_bound(keys_, key);
    return it != keys_.end() && *it == key ? static_cast<std::uint32_t>(it - keys_.begin())
                                           : kOutside;
  }
  /// Returns the one of two bodies that is in the cluster.
  ProbeBody& inside(std::uint32_t a, std::uint32_t b) { return bodies_[a == kOutside ? b : a]; }

  ProbeBody make_body(const Actor* actor) const {
    ProbeBody body;
    body.key = actor ? actor->key : kGroundKey;
    if (!actor) return body;
    body.safe_work_J = actor->least_of_all_J();
    body.limits = actor->impact_limits();
    constexpr double kAny = std::numeric_limits<double>::max();
    body.breakable = may_break(world_, actor, kAny, kAny, kAny);
    const BodyState state = states_[actor->body];
    body.position_W = state.X_WB.position;
    body.velocity_W = state.velocity_W;
    body.angular_velocity_W = state.angular_velocity_W;
    if (actor->is_static) return body;
    const Mat3 rotation = state.X_WB.rotation.toRotationMatrix();
    body.inverse_mass = 1 / actor->weight.mass_kg;
    body.inverse_inertia_W = rotation * actor->weight.inertia_R.inverse() * rotation.transpose();
    return body;
  }

  /// Adds the contacts within the cluster. A body with a contact to the outside, of a separation of
  /// at most `touching_m`, counts as supported.
  void add_contacts(double touching_m) {
    std::vector<BodyId> moving;
    for (const Actor* actor : cluster_) {
      if (actor && !actor->is_static) moving.push_back(actor->body);
    }
    const std::vector<Touch> touches = world_.physics->touches(moving);
    contacts_.reserve(touches.size());
    for (const Touch& touch : touches) {
      const std::uint32_t a = index_of(touch.body_tag_a), b = index_of(touch.body_tag_b);
      if (a == kOutside || b == kOutside) {
        inside(a, b).is_supported |= touch.separation_m <= touching_m;
        continue;
      }
      contacts_.push_back({a, b, touch.shape_tag_a, touch.shape_tag_b, touch.arm_a_W, touch.arm_b_W,
                           touch.normal_W, touch.separation_m});
    }
    merge_patches();
  }

  /// Replaces the contacts of each pair of convexes by their mean if two bodies touch by many such
  /// pairs.
  void merge_patches() {
    std::vector<ProbeContact> merged;
    merged.reserve(contacts_.size());
    const auto bodies = [](const ProbeContact& c) { return std::pair(c.a, c.b); };
    const auto shape_pair = [](const ProbeContact& c) {
      return std::tuple(c.a, c.b, c.shape_a, c.shape_b);
    };
    std::ranges::stable_sort(contacts_, {}, bodies);
    for (std::size_t i = 0, end = 0; i < contacts_.size(); i = end) {
      std::size_t pairs = 0;
      for (end = i; end < contacts_.size() && bodies(contacts_[end]) == bodies(contacts_[i]); ++end)
        pairs += end == i || shape_pair(contacts_[end]) != shape_pair(contacts_[end - 1]);
      if (pairs < kMinMergedPairs) {
        merged.insert(merged.end(), &contacts_[i], &contacts_[i] + (end - i));
        continue;
      }
      for (std::size_t k = i, next = i; k < end; k = next) {
        ProbeContact middle = contacts_[k];
        for (next = k + 1; next < end && shape_pair(contacts_[next]) == shape_pair(middle);
             ++next) {
          middle.arm_a_W += contacts_[next].arm_a_W;
          middle.arm_b_W += contacts_[next].arm_b_W;
          middle.separation_m += contacts_[next].separation_m;
        }
        const double share = 1 / static_cast<double>(next - k);
        middle.arm_a_W *= share, middle.arm_b_W *= share, middle.separation_m *= share;
        merged.push_back(middle);
      }
    }
    contacts_ = std::move(merged);
  }

  /// Returns the indices in Joints::live() of the cluster's joints, ascending.
  std::vector<std::uint32_t> joints_of_cluster() const {
    std::vector<std::uint32_t> all;
    for (const Actor* actor : cluster_) {
      if (!actor || actor->is_static) continue;
      for (const JointGraph::End& end : joints_.ends_at(actor->key)) all.push_back(end.joint);
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Returns the anchor of a joint at an actor (null: the world).
  Vec3 anchor_W(const Joints::End& end, const Actor* actor) const {
    return actor ? rest_pose(*actor, states_[actor->body].X_WB) * end.anchor_R : end.anchor_R;
  }

  /// Adds a joint, or marks its body as supported if the other end is outside the cluster. Skips a
  /// plastic hinge made in this step, which yields before it transmits a load.
  void add_joint(const Joints::Live& joint) {
    if (joint.hinge && joint.hinge->flowed_step == world_.clock.step) return;
    const std::uint32_t a = index_of(joint.a.key), b = index_of(joint.b.key);
    if (a == kOutside || b == kOutside) {
      inside(a, b).is_supported = true;
      return;
    }
    const Vec3 at_a_W = anchor_W(joint.a, cluster_[a]), at_b_W = anchor_W(joint.b, cluster_[b]);
    ProbeJoint probe_joint{joint.desc.kind, a, b};
    probe_joint.arm_a_W = at_a_W - bodies_[a].position_W;
    probe_joint.arm_b_W = at_b_W - bodies_[b].position_W;
    if (joint.desc.kind == JointKind::kRope) {
      const double length_m = (at_a_W - at_b_W).norm();
      ProbeContact rope{a, b};
      rope.arm_a_W = probe_joint.arm_a_W, rope.arm_b_W = probe_joint.arm_b_W;
      if (length_m > 0) rope.normal_W = (at_a_W - at_b_W) / length_m;
      rope.separation_m = joint.desc.length_m - length_m;
      rope.rope = true;
      contacts_.push_back(rope);
      return;
    }
    const Actor* actor = cluster_[a];
    probe_joint.axis_W = actor ? Vec3(states_[actor->body].X_WB.rotation * joint.desc.axis_a_R)
                               : joint.desc.axis_a_R;
    probe_joints_.push_back(probe_joint);
  }

  const WorldState& world_;
  const BodyStates states_;
  const JointGraph& joints_;
  const Cluster& cluster_;
  std::vector<std::uint32_t> keys_;
  std::vector<ProbeBody> bodies_;
  std::vector<ProbeContact> contacts_;
  std::vector<ProbeJoint> probe_joints_;
};

}  // namespace

bool may_break(const WorldState& world, const Actor* actor, double energy_J, double impulse_Ns,
               double speed_m_s) {
  if (!actor || !actor->impact_limits().exceeded(energy_J, impulse_Ns, speed_m_s)) return false;
  return actor->is_static || actor->born_step != world.clock.step + 1;
}

std::unique_ptr<ImpactProbe> make_probe(const WorldState& world, const JointGraph& joints,
                                        const Cluster& cluster) {
  return ProbeBuilder(world, joints, cluster).probe();
}

std::uint64_t fingerprint(const ImpactProbe& probe) {
  std::uint64_t print = probe.bodies().size();
  const auto add = [&](std::uint64_t bits) { print = combine(print, bits); };
  const auto add_pair = [&](std::uint64_t a, std::uint64_t b) { add(a << 32 | b); };
  const auto add_vector = [&](const Vec3& v) {
    for (const double part : v) add(std::bit_cast<std::uint64_t>(part));
  };
  for (const ProbeBody& body : probe.bodies()) {
    add_pair(body.key, body.breakable);
    add_vector(body.position_W);
    add_vector(body.velocity_W);
    add_vector(body.angular_velocity_W);
  }
  for (const ProbeContact& contact : probe.contacts()) {
    add_pair(contact.a, contact.b);
    add_pair(contact.shape_a, contact.shape_b);
    add(std::bit_cast<std::uint64_t>(contact.separation_m));
  }
  for (const ProbeJoint& joint : probe.joints()) add_pair(joint.a, joint.b);
  return print;
}

}  // namespace sunder
