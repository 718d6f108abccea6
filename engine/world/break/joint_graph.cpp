#include "engine/world/break/joint_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/base/disjoint_sets.h"

namespace sunder {

JointGraph::JointGraph(const World& world) : world_(world), states_(world.physics->states()) {
  const std::vector<Joints::Live>& joints = world.joints.live();
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    ends_.push_back({joints[i].a.key, i});
    ends_.push_back({joints[i].b.key, i});
  }
  std::ranges::sort(ends_, {}, [](const End& end) { return std::tuple(end.key, end.joint); });
  DisjointSets sets(joints.size());
  for (std::size_t i = 1; i < ends_.size(); ++i) {
    if (ends_[i].key == ends_[i - 1].key && !alone(ends_[i].key).held) {
      sets.join(ends_[i - 1].joint, ends_[i].joint);
    }
  }
  whole_of_ = sets.roots();
  wholes_.resize(joints.size());
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const Whole one = alone(ends_[i].key);
    Whole& all = wholes_[whole_of_[ends_[i].joint]];
    all.held |= one.held;
    if (one.held || (i > 0 && ends_[i].key == ends_[i - 1].key)) continue;
    all.mass_kg += one.mass_kg;
    all.kinetic_J += one.kinetic_J;
  }
}

std::span<const JointGraph::End> JointGraph::of(std::uint32_t key) const {
  const auto first = std::ranges::lower_bound(ends_, key, {}, &End::key);
  return {first, std::ranges::upper_bound(first, ends_.end(), key, {}, &End::key)};
}

JointGraph::Whole JointGraph::alone(std::uint32_t key) const {
  const Actor* actor = world_.actors.find(key);
  if (actor && actor->is_kinematic) return {0, std::numeric_limits<double>::infinity(), true};
  if (!actor || actor->is_static) return {0, 0, true};
  const BodyState state = states_[actor->body];
  const Vec3 w_B = state.X_WB.rotation.conjugate() * state.angular_velocity_W;
  const double mass_kg = actor->weight.mass_kg;
  return {
      mass_kg,
      0.5 * mass_kg * state.velocity_W.squaredNorm() + 0.5 * w_B.dot(actor->weight.inertia_R * w_B),
      false};
}

JointGraph::Whole JointGraph::whole(std::uint32_t key) const {
  const Whole one = alone(key);
  const std::span<const End> ends = of(key);
  return one.held || ends.empty() ? one : wholes_[whole_of_[ends.front().joint]];
}

double JointGraph::falls_J_kg(const Approach& approach) const {
  return std::abs(world_.scene.gravity_W.dot(approach.normal_W)) *
         std::max(0.0, approach.separation_m);
}

double JointGraph::closing_speed_m_s(const Approach& approach) const {
  return std::sqrt(approach.speed_m_s * approach.speed_m_s + 2 * falls_J_kg(approach));
}

double JointGraph::closing_energy_J(const Approach& approach) const {
  const double falls_J_kg = this->falls_J_kg(approach);
  const double each_J_kg = 0.5 * approach.speed_m_s * approach.speed_m_s + falls_J_kg;
  const std::uint32_t a = approach.body_tag_a, b = approach.body_tag_b;
  const std::span<const End> ends_a = of(a), ends_b = of(b);
  if (ends_a.empty() && ends_b.empty()) return approach.effective_mass_kg * each_J_kg;
  const Whole all_a = whole(a), all_b = whole(b);
  const double most_J =
      all_a.kinetic_J + all_b.kinetic_J + falls_J_kg * (all_a.mass_kg + all_b.mass_kg);
  const double give = (all_a.held ? 0 : 1 / all_a.mass_kg) + (all_b.held ? 0 : 1 / all_b.mass_kg);
  const bool within = !ends_a.empty() && !ends_b.empty() &&
                      whole_of_[ends_a.front().joint] == whole_of_[ends_b.front().joint];
  return give > 0 && !within ? std::min(most_J, each_J_kg / give) : most_J;
}

}  // namespace sunder
