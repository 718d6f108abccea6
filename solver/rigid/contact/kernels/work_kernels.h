// Sums and work of the impulses of a step. Read first: find_work(). Included only by sweep_1.cpp
// and so on, under the rule of sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/kernels/sweep_kernels.h"

namespace sunder::solver {

template <std::uint32_t lanes>
void sum_impulses(ConstraintBlock<lanes>& c) {
  for_all_impulses(c, [&](std::uint32_t slot, const WideOf<lanes>& impulse) {
    c.step_impulse[slot] += impulse;
  });
}

/// Calls visit(slot, direction, Jacobian on a, Jacobian on b) for each impulse of a block; the
/// direction is zero for angular ones.
template <std::uint32_t lanes, class Visit>
SUNDER_INLINE void for_all_jacobians(const ConstraintBlock<lanes>& c, const Visit& visit) {
  const Wide3Of<lanes> none = {};
  for (std::uint32_t i = 0; i < c.points; ++i)
    visit(i, c.normal, c.point[i].angular_a, c.point[i].angular_b);
  visit(4, c.tangent_1, c.friction_1_a, c.friction_1_b);
  visit(5, c.tangent_2, c.friction_2_a, c.friction_2_b);
  if (c.points > 1) visit(6, none, c.twist_a, c.twist_b);
  if (!c.rolls) return;
  visit(7, none, c.roll.angular_1_a, c.roll.angular_1_b);
  visit(8, none, c.roll.angular_2_a, c.roll.angular_2_b);
}

template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void find_work_as(ConstraintBlock<lanes>& c, const SolverRows& bodies) {
  using V = WideOf<lanes>;
  const V half = splat<V>(0.5f), zero = {};
  const auto& p = c.step_impulse;
  const V normal = p[0] + p[1] + p[2] + p[3];
  c.total = c.normal * normal + c.tangent_1 * p[4] + c.tangent_2 * p[5];
  c.work.allowed_Ns = c.friction * normal;
  c.work.excess_Ns = max(zero, sqrt(p[4] * p[4] + p[5] * p[5]) - c.work.allowed_Ns);
  Pairs<lanes, kSplit> mean(c, bodies, &BodyRow::start);
  const Pairs<lanes, kSplit> end(c, bodies, &BodyRow::velocity);
  mean.a = {(mean.a.linear + end.a.linear) * half, (mean.a.angular + end.a.angular) * half};
  mean.b = {(mean.b.linear + end.b.linear) * half, (mean.b.angular + end.b.angular) * half};
  V carried_a = {}, carried_b = {};
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    carried_a[lane] = c.row_a[lane] < 0, carried_b[lane] = c.row_b[lane] < 0;
  const bool carries = any(carried_a + carried_b > zero);
  for_all_jacobians(c, [&](std::uint32_t slot, const Wide3Of<lanes>& direction,
                           const Wide3Of<lanes>& on_a, const Wide3Of<lanes>& on_b) {
    const V impulse = c.step_impulse[slot];
    (slot < 4 ? c.work.normal_J : c.work.friction_J) += impulse * mean.along(direction, on_a, on_b);
    if (!carries) return;
    const V by_a = dot(direction, mean.a.linear) + dot(on_a, mean.a.angular);
    const V by_b = dot(direction, mean.b.linear) + dot(on_b, mean.b.angular);
    c.work.drive_J += impulse * (carried_a * by_a - carried_b * by_b);
  });
}

template <std::uint32_t lanes>
void find_work(ConstraintBlock<lanes>& c, const SolverRows& bodies) {
  c.split ? find_work_as<true>(c, bodies) : find_work_as<false>(c, bodies);
}

template <std::uint32_t lanes>
void scale_impulses(ConstraintBlock<lanes>& c, ArmLanes<lanes>* arms, const float* scale_of_row) {
  using V = WideOf<lanes>;
  const V share = scale_of<lanes>(c, scale_of_row);
  for_all_impulses(c, [&](std::uint32_t slot, const V& impulse) {
    c.step_impulse[slot] += impulse * (share - splat<V>(1));
  });
  for_all_impulses(c, [&](std::uint32_t, V& impulse) { impulse *= share; });
  if (arms) arms->pending_a = arms->pending_a * share, arms->pending_b = arms->pending_b * share;
}

}  // namespace sunder::solver
