#include "solver/rigid/contact/energy_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/disjoint_sets.h"
#include "solver/rigid/tolerances.h"

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
                          std::span<const BodySlot> carried, const Bodies& bodies,
                          const Contacts& contacts) {
  const double slow_m_s = kGuardedSpeed * step.fall_m_s;
  watches_ = kGuards && std::ranges::any_of(active, [&](BodySlot body) {
               return bodies.fastest_m_s(body) > slow_m_s;
             });
  if (!watches_) return;
  DisjointSets groups(bodies.size());
  falls_.assign(bodies.size(), 1);
  const auto join = [&](BodySlot a, BodySlot b) {
    const bool a_moves = !a.none() && bodies.awake(a), b_moves = !b.none() && bodies.awake(b);
    if (a_moves && b_moves) groups.join(a.value, b.value);
    if (a_moves && !b_moves) falls_[a] = 0;
    if (b_moves && !a_moves) falls_[b] = 0;
  };
  for (const ManifoldSlot i : manifolds)
    join(contacts.manifolds[i].body_a, contacts.manifolds[i].body_b);
  for (const auto& [a, b] : joined) join(a, b);
  group_.resize(bodies.size());
  for (const BodySlot body : bodies.slots()) group_[body] = BodySlot(groups.root(body.value));
  leave_alone_what_is_carried(manifolds, carried, active, bodies, contacts);
  for (const BodySlot body : active)
    if (!falls_[body] && !group_[body].none()) falls_[group_[body]] = 0;
  for (const BodySlot body : active)
    if (!group_[body].none()) falls_[body] = falls_[group_[body]];
  if (!joined.empty()) leave_alone_what_swings_free(manifolds, active, joined, contacts);
  of_body_.assign(bodies.size(), {});
  of_group_.assign(bodies.size(), {});
  share_.assign(bodies.size() + 1, 1);
}

/// Excludes groups that kinematic bodies do work on, by contacts or joints.
void EnergyGuard::leave_alone_what_is_carried(std::span<const ManifoldSlot> manifolds,
                                              std::span<const BodySlot> by_joints,
                                              std::span<const BodySlot> active,
                                              const Bodies& bodies, const Contacts& contacts) {
  ByBody<std::uint8_t> carried(bodies.size());
  bool any = false;
  for (const BodySlot body : by_joints) carried[group_[body]] = any = true;
  for (const ManifoldSlot i : manifolds) {
    const Manifold& m = contacts.manifolds[i];
    if (bodies.carries(m.body_a)) carried[group_[m.body_b]] = any = true;
    if (bodies.carries(m.body_b)) carried[group_[m.body_a]] = any = true;
  }
  if (!any) return;
  for (const BodySlot body : active)
    if (carried[group_[body]]) group_[body] = {};
}

/// Excludes groups that touch nothing and hang in joints: joints keep their energy as well as their
/// substeps do, and a guard would only take some.
void EnergyGuard::leave_alone_what_swings_free(std::span<const ManifoldSlot> manifolds,
                                               std::span<const BodySlot> active,
                                               std::span<const Pair> joined,
                                               const Contacts& contacts) {
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

void EnergyGuard::weigh_base(BodySlot body, float inverse_mass, const BodyRow& row) {
  of_body_[body].struck_J = -0.5 * lanes_sum(row.base, row.base, 1 / double{inverse_mass});
}

void EnergyGuard::weigh(BodySlot body, float inverse_mass, const BodyRow& row) {
  const Wide change = row.velocity - row.base;
  const double mass = 1 / double{inverse_mass};
  Work& work = of_body_[body];
  work.first = lanes_sum(change, row.base, mass);
  work.second = 0.5 * lanes_sum(change, change, mass);
  work.struck_J += 0.5 * lanes_sum(row.base, row.base, mass);
}

void EnergyGuard::judge(std::span<const BodySlot> active) {
  objects_ = false;
  for (const BodySlot body : active)
    if (!group_[body].none()) of_group_[group_[body]].first = of_group_[group_[body]].second = 0;
  for (const BodySlot body : active) {
    if (group_[body].none()) continue;
    Work& work = of_group_[group_[body]];
    work.first += of_body_[body].first;
    work.second += of_body_[body].second;
    work.made_J += of_body_[body].struck_J;
  }
  for (const BodySlot body : active) {
    float& share = share_[row_of(body)];
    share = 1;
    if (group_[body].none()) continue;
    Work& work = of_group_[group_[body]];
    if (work.first + work.second > kEnergyRounding * work.second) {
      share = static_cast<float>(std::max(0.0, -kShareRounding * work.first / work.second));
      objects_ = true;
    } else if (group_[body] == body) {
      work.made_J += work.first + work.second;
    }
    Work& own = of_body_[body];
    own.made_J += own.struck_J + double{share} * (own.first + double{share} * own.second);
  }
}

void EnergyGuard::ask(BodySlot body, double made_J, float inverse_mass, const BodyRow& row) {
  const double mass = 1 / double{inverse_mass};
  const auto energy = [&](const Wide& v, double linear) { return 0.5 * lanes_sum(v, v, linear); };
  const double motion_J = std::max(energy(row.start, mass), energy(row.velocity, mass));
  const double own_J = std::max(-of_body_[body].made_J, motion_J - energy(row.velocity, 0));
  of_body_[body].asked_J =
      made_J <= own_J ? std::max(0.0, made_J) : std::numeric_limits<double>::infinity();
}

void EnergyGuard::decide(std::span<const BodySlot> active) {
  if (!watches_) return;
  for (const BodySlot body : active)
    if (!group_[body].none() && std::isfinite(of_body_[body].asked_J))
      of_group_[group_[body]].made_J += of_body_[body].asked_J;
}

bool EnergyGuard::grants(BodySlot body) const {
  if (!watches_ || group_[body].none() || of_body_[body].asked_J <= 0) return true;
  return std::isfinite(of_body_[body].asked_J) && of_group_[group_[body]].made_J <= 0;
}

}  // namespace sunder::solver
