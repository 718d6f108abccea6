#include "solver/rigid/contact/energy_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/disjoint_sets.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr double kEnergyRounding = 1e-6;  // of the energy exchanged
constexpr double kShareRounding = 1 - 1e-6;

double lanes_sum(const Wide& a, const Wide& b, double linear) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 3; ++i) sum += linear * double{a[i]} * double{b[i]};
  for (std::uint32_t i = 3; i < 6; ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}

}  // namespace

void EnergyGuard::collect(const StepContext& step, std::span<const ManifoldSlot> manifolds,
                          std::span<const BodySlot> active, std::span<const Pair> joined,
                          std::span<const BodySlot> driven, const Bodies& bodies,
                          const Contacts& contacts) {
  const double slow_m_s = kGuardedSpeed * step.fall_m_s;
  is_active_ = std::ranges::any_of(
      active, [&](BodySlot body) { return bodies.fastest_m_s(body) > slow_m_s; });
  if (!is_active_) return;
  DisjointSets groups(bodies.size());
  in_free_fall_.assign(bodies.size(), 1);
  const auto join = [&](BodySlot a, BodySlot b) {
    const bool a_moves = !a.none() && bodies.awake(a), b_moves = !b.none() && bodies.awake(b);
    if (a_moves && b_moves) groups.join(a.value, b.value);
    if (a_moves && !b_moves) in_free_fall_[a] = 0;
    if (b_moves && !a_moves) in_free_fall_[b] = 0;
  };
  for (const ManifoldSlot i : manifolds)
    join(contacts.manifolds[i].body_a, contacts.manifolds[i].body_b);
  for (const auto& [a, b] : joined) join(a, b);
  group_.resize(bodies.size());
  for (const BodySlot body : bodies.slots()) group_[body] = BodySlot(groups.root(body.value));
  exclude_driven(manifolds, driven, active, bodies, contacts);
  for (const BodySlot body : active)
    if (!in_free_fall_[body] && !group_[body].none()) in_free_fall_[group_[body]] = 0;
  for (const BodySlot body : active)
    if (!group_[body].none()) in_free_fall_[body] = in_free_fall_[group_[body]];
  if (!joined.empty()) exclude_free_hanging(manifolds, active, joined, contacts);
  of_body_.assign(bodies.size(), {});
  of_group_.assign(bodies.size(), {});
  scale_.assign(bodies.size() + 1, 1);
}

/// Excludes groups that kinematic bodies do work on, by contacts or joints.
void EnergyGuard::exclude_driven(std::span<const ManifoldSlot> manifolds,
                                 std::span<const BodySlot> by_joints,
                                 std::span<const BodySlot> active, const Bodies& bodies,
                                 const Contacts& contacts) {
  ByBody<std::uint8_t> driven(bodies.size());
  bool any = false;
  for (const BodySlot body : by_joints) driven[group_[body]] = any = true;
  for (const ManifoldSlot i : manifolds) {
    const Manifold& m = contacts.manifolds[i];
    if (bodies.is_moving_kinematic(m.body_a)) driven[group_[m.body_b]] = any = true;
    if (bodies.is_moving_kinematic(m.body_b)) driven[group_[m.body_a]] = any = true;
  }
  if (!any) return;
  for (const BodySlot body : active)
    if (driven[group_[body]]) group_[body] = {};
}

/// Excludes groups that touch nothing and hang in joints: joints keep their energy as well as their
/// substeps do, and a guard would only take some.
void EnergyGuard::exclude_free_hanging(std::span<const ManifoldSlot> manifolds,
                                       std::span<const BodySlot> active,
                                       std::span<const Pair> joined, const Contacts& contacts) {
  ByBody<std::uint8_t> free(group_.size());
  const auto mark = [&](BodySlot body, bool is_free) {
    if (!group_[body].none()) free[group_[body]] = is_free;
  };
  for (const auto& [a, b] : joined) mark(a, true), mark(b, true);
  for (const ManifoldSlot i : manifolds) {
    mark(contacts.manifolds[i].body_a, false), mark(contacts.manifolds[i].body_b, false);
  }
  for (const BodySlot body : active)
    if (!group_[body].none() && free[group_[body]]) group_[body] = {};
}

void EnergyGuard::record_energy_before(BodySlot body, float inverse_mass, const BodyRow& row) {
  of_body_[body].restitution_J = -0.5 * lanes_sum(row.base, row.base, 1 / double{inverse_mass});
}

void EnergyGuard::record_impulse_work(BodySlot body, float inverse_mass, const BodyRow& row) {
  const Wide change = row.velocity - row.base;
  const double mass = 1 / double{inverse_mass};
  Work& work = of_body_[body];
  work.first = lanes_sum(change, row.base, mass);
  work.second = 0.5 * lanes_sum(change, change, mass);
  work.restitution_J += 0.5 * lanes_sum(row.base, row.base, mass);
}

void EnergyGuard::find_impulse_scales(std::span<const BodySlot> active) {
  needs_scaling_ = false;
  for (const BodySlot body : active)
    if (!group_[body].none()) of_group_[group_[body]].first = of_group_[group_[body]].second = 0;
  for (const BodySlot body : active) {
    if (group_[body].none()) continue;
    Work& work = of_group_[group_[body]];
    work.first += of_body_[body].first;
    work.second += of_body_[body].second;
    work.gained_J += of_body_[body].restitution_J;
  }
  for (const BodySlot body : active) {
    float& share = scale_[row_of(body)];
    share = 1;
    if (group_[body].none()) continue;
    Work& work = of_group_[group_[body]];
    if (work.first + work.second > kEnergyRounding * work.second) {
      share = static_cast<float>(std::max(0.0, -kShareRounding * work.first / work.second));
      needs_scaling_ = true;
    } else if (group_[body] == body) {
      work.gained_J += work.first + work.second;
    }
    Work& own = of_body_[body];
    own.gained_J += own.restitution_J + double{share} * (own.first + double{share} * own.second);
  }
}

void EnergyGuard::request_rotation_energy(BodySlot body, double gained_J, float inverse_mass,
                                          const BodyRow& row) {
  const double mass = 1 / double{inverse_mass};
  const auto energy = [&](const Wide& v, double linear) { return 0.5 * lanes_sum(v, v, linear); };
  const double motion_J = std::max(energy(row.start, mass), energy(row.velocity, mass));
  const double own_J = std::max(-of_body_[body].gained_J, motion_J - energy(row.velocity, 0));
  of_body_[body].requested_J =
      gained_J <= own_J ? std::max(0.0, gained_J) : std::numeric_limits<double>::infinity();
}

void EnergyGuard::sum_requests(std::span<const BodySlot> active) {
  if (!is_active_) return;
  for (const BodySlot body : active)
    if (!group_[body].none() && std::isfinite(of_body_[body].requested_J))
      of_group_[group_[body]].gained_J += of_body_[body].requested_J;
}

bool EnergyGuard::may_keep_angular_momentum(BodySlot body) const {
  if (!is_active_ || group_[body].none() || of_body_[body].requested_J <= 0) return true;
  return std::isfinite(of_body_[body].requested_J) && of_group_[group_[body]].gained_J <= 0;
}

}  // namespace sunder::solver
