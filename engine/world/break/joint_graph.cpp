#include "engine/world/break/joint_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/base/disjoint_sets.h"

namespace sunder {

JointGraph::JointGraph(const WorldState& world) : world_(world), states_(world.physics->states()) {
  const std::vector<Joints::Live>& joints = world.joints.live();
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    ends_.push_back({joints[i].a.key, i});
    ends_.push_back({joints[i].b.key, i});
  }
  std::ranges::sort(ends_, {}, [](const End& end) { return std::tuple(end.key, end.joint); });
  DisjointSets sets(joints.size());
  for (std::size_t i = 1; i < ends_.size(); ++i) {
    if (ends_[i].key == ends_[i - 1].key && !single_body(ends_[i].key).held) {
      sets.join(ends_[i - 1].joint, ends_[i].joint);
    }
  }
  assembly_of_ = sets.roots();
  assemblies_.resize(joints.size());
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const Assembly body = single_body(ends_[i].key);
    Assembly& all = assemblies_[assembly_of_[ends_[i].joint]];
    all.held |= body.held;
    if (body.held || (i > 0 && ends_[i].key == ends_[i - 1].key)) continue;
    all.mass_kg += body.mass_kg;
    all.kinetic_J += body.kinetic_J;
  }
}

std::span<const JointGraph::End> JointGraph::ends_at(std::uint32_t key) const {
  const auto first = std::ranges::lower_bound(ends_, key, {}, &End::key);
  return {first, std::ranges::upper_bound(first, ends_.end(), key, {}, &End::key)};
}

JointGraph::Assembly JointGraph::single_body(std::uint32_t key) const {
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

JointGraph::Assembly JointGraph::assembly(std::uint32_t key) const {
  const Assembly body = single_body(key);
  const std::span<const End> ends = ends_at(key);
  return body.held || ends.empty() ? body : assemblies_[assembly_of_[ends.front().joint]];
}

double JointGraph::fall_energy_J_kg(const SpeculativeContact& approach) const {
  return std::abs(world_.scene.gravity_W.dot(approach.normal_W)) *
         std::max(0.0, approach.separation_m);
}

double JointGraph::closing_speed_m_s(const SpeculativeContact& approach) const {
  return std::sqrt(approach.speed_m_s * approach.speed_m_s + 2 * fall_energy_J_kg(approach));
}

double JointGraph::closing_energy_J(const SpeculativeContact& approach) const {
  const double fall_energy_J_kg = this->fall_energy_J_kg(approach);
  const double each_J_kg = 0.5 * approach.speed_m_s * approach.speed_m_s + fall_energy_J_kg;
  const std::uint32_t a = approach.body_tag_a, b = approach.body_tag_b;
  const std::span<const End> ends_a = ends_at(a), ends_b = ends_at(b);
  if (ends_a.empty() && ends_b.empty()) return approach.effective_mass_kg * each_J_kg;
  const Assembly all_a = assembly(a), all_b = assembly(b);
  const double max_J =
      all_a.kinetic_J + all_b.kinetic_J + fall_energy_J_kg * (all_a.mass_kg + all_b.mass_kg);
  const double inverse_mass =
      (all_a.held ? 0 : 1 / all_a.mass_kg) + (all_b.held ? 0 : 1 / all_b.mass_kg);
  const bool is_one_assembly =
      !ends_a.empty() && !ends_b.empty() &&
      assembly_of_[ends_a.front().joint] == assembly_of_[ends_b.front().joint];
  return inverse_mass > 0 && !is_one_assembly ? std::min(max_J, each_J_kg / inverse_mass) : max_J;
}

}  // namespace sunder
