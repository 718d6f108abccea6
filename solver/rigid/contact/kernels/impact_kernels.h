// Propagation of impacts (docs/decisions/036). Few contacts near an impact have a body that moved,
// and these are scattered over blocks: sweeps gather them into lanes, whatever their block. Read
// first: propagate(). Included only by sweep_1.cpp and so on, under the rule of sweep_kernels.h.
#pragma once

#include <algorithm>

#include "solver/rigid/contact/kernels/restitution_kernels.h"
#include "solver/rigid/contact/kernels/work_kernels.h"

namespace sunder::solver {

/// Change of speed that is propagated, as a fraction of the speed of the slowest impact.
inline constexpr float kPropagatedChange = 0.1f;

/// Returns the closing speed of a point beyond that of the slowest impact; at most 0: no impact.
/// Points that are yet to rebound are left to restitution, as in solve_normal().
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> excess_speed(const ConstraintBlock<lanes>& c,
                                         const ImpactLanes<lanes>& impact, std::uint32_t i,
                                         WideOf<lanes> speed) {
  const WideOf<lanes> zero = {};
  const auto rebounds = (impact.gap_m_s[i] > zero) & (c.rebound.restitution > zero);
  const WideOf<lanes> closes = rebounds ? (c.point[i].impulse > zero ? -speed : zero) : -speed;
  return c.point[i].mass > zero ? closes - impact.least_m_s : zero;
}

template <std::uint32_t lanes>
bool find_gaps(const ConstraintBlock<lanes>& c, ImpactLanes<lanes>& impact,
               const SolverRows& bodies, float inverse_h) {
  using V = WideOf<lanes>;
  const V zero = {};
  const Pairs<lanes, false> v(c, bodies, &BodyRow::velocity), x(c, bodies, &BodyRow::position);
  V fastest = zero;
  for (std::uint32_t i = 0; i < c.points; ++i) {
    const PointLanes<lanes>& p = c.point[i];
    const V s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
    impact.gap_m_s[i] = max(zero, s) * inverse_h;
    const V u = v.along(c.normal, p.angular_a, p.angular_b) + impact.gap_m_s[i];
    fastest = max(fastest, excess_speed(c, impact, i, u));
  }
  return any(fastest > zero);
}

/// Solves the normal impulses, as solve_normal() does; returns how far the fastest closing speed
/// exceeds that of the slowest impact.
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> solve_normal_of_impact(ConstraintBlock<lanes>& c,
                                                   Pairs<lanes, false>& v,
                                                   const ImpactLanes<lanes>& impact, float omega) {
  using V = WideOf<lanes>;
  const V zero = {};
  V fastest = zero;
  for (std::uint32_t i = 0; i < c.points; ++i) {
    PointLanes<lanes>& p = c.point[i];
    const V u = v.along(c.normal, p.angular_a, p.angular_b) + impact.gap_m_s[i];
    fastest = max(fastest, excess_speed(c, impact, i, u));
    V change = -p.mass * u;
    if (c.bouncy) {
      const auto rebounds = (impact.gap_m_s[i] > zero) & (c.rebound.restitution > zero);
      change = rebounds ? (p.impulse > zero ? change : zero) : change;
    }
    const V next = max(zero, p.impulse + omega * change);
    v.apply_impulse(c, c.normal, p.angular_a, p.angular_b, next - p.impulse);
    p.impulse = next;
  }
  return fastest;
}

/// Returns 1 for lanes whose impulses changed enough to be propagated.
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> find_changed(ConstraintBlock<lanes>& c,
                                         const ImpactLanes<lanes>& impact,
                                         const WideOf<lanes> (&was)[9]) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1), least = kPropagatedChange * impact.least_m_s;
  V changed = zero;
  for_impulses(c, [&](std::uint32_t slot, const V& impulse, const V& mass) {
    if (slot == 6) return;  // a torque
    const V change = max(impulse - was[slot], was[slot] - impulse);
    changed = change > least * mass ? one : changed;
  });
  return changed;
}

/// Rows of ImpactContact: impulses, points, rolling.
inline constexpr std::uint32_t kImpulseRow = 5, kPointRow = 6, kRollRow = 10;

/// Calls visit(row, eight lanes of the block) for the data of a sweep, in the order of
/// ImpactContact; that of rolling only if `rolls`.
template <std::uint32_t lanes, class Visit>
SUNDER_INLINE void for_frames(ConstraintBlock<lanes>& c, ImpactLanes<lanes>& impact, bool rolls,
                              const Visit& visit) {
  auto &n = c.normal, &t_1 = c.tangent_1, &t_2 = c.tangent_2;
  auto &a_1 = c.friction_1_a, &b_1 = c.friction_1_b, &a_2 = c.friction_2_a, &b_2 = c.friction_2_b;
  auto &a = c.twist_a, &b = c.twist_b;
  auto& gap = impact.gap_m_s;
  visit(0, n.x, n.y, n.z, t_1.x, t_1.y, t_1.z, c.inverse_mass_a, c.inverse_mass_b);
  visit(1, t_2.x, t_2.y, t_2.z, a_1.x, a_1.y, a_1.z, c.friction, impact.least_m_s);
  visit(2, b_1.x, b_1.y, b_1.z, a_2.x, a_2.y, a_2.z, c.friction_mass_11, c.friction_mass_12);
  visit(3, b_2.x, b_2.y, b_2.z, a.x, a.y, a.z, c.friction_mass_22, c.twist_mass);
  visit(4, b.x, b.y, b.z, gap[0], gap[1], gap[2], gap[3], c.rebound.restitution);
  if (!rolls) return;
  RollLanes<lanes>& r = c.roll;
  auto &r_1a = r.angular_1_a, &r_1b = r.angular_1_b, &r_2a = r.angular_2_a, &r_2b = r.angular_2_b;
  visit(kRollRow, r_1a.x, r_1a.y, r_1a.z, r_1b.x, r_1b.y, r_1b.z, r.mass_11, r.mass_12);
  visit(kRollRow + 1, r_2a.x, r_2a.y, r_2a.z, r_2b.x, r_2b.y, r_2b.z, r.mass_22, r.arm);
}
/// Calls visit(row, eight lanes of the block) for the data of point i.
template <std::uint32_t lanes, class Visit>
SUNDER_INLINE void for_point(PointLanes<lanes>& p, std::uint32_t i, const Visit& visit) {
  auto &a = p.angular_a, &b = p.angular_b;
  visit(kPointRow + i, a.x, a.y, a.z, b.x, b.y, b.z, p.mass, p.arm);
}
/// Calls visit(row, eight lanes of the block) for the impulses; those of rolling only if `rolls`.
template <std::uint32_t lanes, class Visit>
SUNDER_INLINE void for_impulse_rows(ConstraintBlock<lanes>& c, bool rolls, const Visit& visit) {
  WideOf<lanes> none = {};
  visit(kImpulseRow, c.point[0].impulse, c.point[1].impulse, c.point[2].impulse, c.point[3].impulse,
        c.friction_impulse_1, c.friction_impulse_2, c.twist_impulse, none);
  if (rolls)
    visit(kRollRow + 2, c.roll.impulse_1, c.roll.impulse_2, none, none, none, none, none, none);
}

/// Memory of the lanes' rows.
template <std::uint32_t lanes>
struct ContactRows {
  float* of[lanes];

  /// Reads eight floats of each lane.
  template <class... V>
  SUNDER_INLINE void get(std::uint32_t row, V&... to) const {
    WideOf<lanes> v[8];
    load_eight(of, 8 * row, v);
    int i = 0;
    ((to = v[i++]), ...);
  }
  template <class... V>
  SUNDER_INLINE void put(std::uint32_t row, const V&... from) const {
    WideOf<lanes> v[8] = {from...};
    store_eight(v, of, 8 * row);
  }
};

template <std::uint32_t lanes>
void extract_contacts(ConstraintBlock<lanes>& c, ImpactLanes<lanes>& impact, ImpactPair* pairs,
                      ImpactContact* contacts) {
  for_all_impulses(c, [&](std::uint32_t slot, WideOf<lanes>& impulse) {
    impact.saved[slot] = impulse;
    impulse = WideOf<lanes>{};
  });
  ImpactContact none;
  ContactRows<lanes> rows;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    ImpactContact& contact = lane < c.count ? contacts[lane] : none;
    contact.points = c.points;
    contact.rolls = c.rolls;
    std::fill(contact.row[kImpulseRow], contact.row[kImpulseRow + 1], 0.f);
    std::fill(contact.row[kPointRow + c.points], contact.row[kRollRow + 3], 0.f);
    rows.of[lane] = contact.row[0];
    if (lane < c.count) pairs[lane] = {c.row_a[lane], c.row_b[lane]};
  }
  const auto put = [&](std::uint32_t row, const auto&... v) { rows.put(row, v...); };
  for (std::uint32_t i = c.points; i < 4; ++i) impact.gap_m_s[i] = WideOf<lanes>{};
  for_frames(c, impact, c.rolls, put);
  for (std::uint32_t i = 0; i < c.points; ++i) for_point(c.point[i], i, put);
}

template <std::uint32_t lanes>
void apply_propagation(ConstraintBlock<lanes>& c, const ImpactLanes<lanes>& impact,
                       ImpactContact* contacts, const SolverRows& bodies) {
  ImpactContact none;
  ContactRows<lanes> rows;
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    rows.of[lane] = (lane < c.count ? contacts[lane] : none).row[0];
  for_impulse_rows(c, c.rolls, [&](std::uint32_t row, auto&... v) { rows.get(row, v...); });
  warm_start(c, bodies);
  sum_impulses(c);
  for_all_impulses(
      c, [&](std::uint32_t slot, WideOf<lanes>& impulse) { impulse = impact.saved[slot]; });
}

/// One pass like sweep_relaxed() over contacts of one colour. Returns true if a point closed as
/// fast as an impact. Not shared by the kernels of different `most` lanes, whose instructions it
/// uses.
template <std::uint32_t lanes, std::uint32_t most>
[[gnu::noinline]] bool propagate_lanes(const ImpactPair* pair, ImpactContact* const* contact,
                                       const SolverRows& bodies, const SoftStep& soft,
                                       const ImpactSweep& sweep) {
  using V = WideOf<lanes>;
  const V zero = {};
  ConstraintBlock<lanes> c;
  ImpactLanes<lanes> impact;
  ContactRows<lanes> rows;
  c.bouncy = true;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    c.row_a[lane] = pair[lane].row_a, c.row_b[lane] = pair[lane].row_b;
    c.points = std::max(c.points, contact[lane]->points);
    c.rolls |= contact[lane]->rolls;
    rows.of[lane] = contact[lane]->row[0];
  }
  const auto get = [&](std::uint32_t row, auto&... v) { rows.get(row, v...); };
  for_frames(c, impact, c.rolls, get);
  for (std::uint32_t i = 0; i < c.points; ++i) for_point(c.point[i], i, get);
  for_impulse_rows(c, c.rolls, get);
  V was[9];
  for_all_impulses(c, [&](std::uint32_t slot, const V& impulse) { was[slot] = impulse; });
  Pairs<lanes, false> v(c, bodies, &BodyRow::velocity);
  solve_tangents<false>(c, v, v, soft);
  const V fastest = solve_normal_of_impact(c, v, impact, soft.omega);
  store(c, v, bodies);
  for_impulse_rows(c, c.rolls, [&](std::uint32_t row, auto&... of) { rows.put(row, of...); });
  for (std::uint32_t set = bits(find_changed(c, impact, was) > zero); set != 0; set &= set - 1) {
    const int lane = __builtin_ctz(set);
    for (const std::int32_t row : {c.row_a[lane], c.row_b[lane]})
      if (row > 0) sweep.moved[row] = sweep.now;
  }
  return any(fastest > zero);
}

template <std::uint32_t lanes>
bool propagate(const ImpactPair* pairs, ImpactContact* contacts, std::uint32_t count,
               const SolverRows& bodies, const SoftStep& soft, const ImpactSweep& sweep) {
  bool any = false;
  std::uint32_t found = 0;
  ImpactPair pair[lanes];
  ImpactContact* contact[lanes];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint8_t a = sweep.moved[pairs[i].row_a], b = sweep.moved[pairs[i].row_b];
    pair[found] = pairs[i];
    contact[found] = contacts + i;
    found += std::max(a, b) >= sweep.since;
    if (found < lanes) continue;
    any |= propagate_lanes<lanes, lanes>(pair, contact, bodies, soft, sweep);
    found = 0;
  }
  if (found == 0) return any;
  ImpactContact none;
  for (std::uint32_t i = found; i < lanes; ++i) pair[i] = {}, contact[i] = &none;
  // Remaining contacts use as few lanes as possible.
  if (lanes > 4 && found <= 4)
    return any | propagate_lanes<4, lanes>(pair, contact, bodies, soft, sweep);
  if (lanes > 8 && found <= 8)
    return any | propagate_lanes<8, lanes>(pair, contact, bodies, soft, sweep);
  return any | propagate_lanes<lanes, lanes>(pair, contact, bodies, soft, sweep);
}

/// Compiles all kernels for a number of lanes.
#define SUNDER_SWEEP_KERNELS(lanes)                                                               \
  template void derive(GatheredBlock<lanes>&, ConstraintBlock<lanes>&);                           \
  template void update_arms(ConstraintBlock<lanes>&, ArmLanes<lanes>&, const SolverRows&, float); \
  template void apply_arm_change(ConstraintBlock<lanes>&, ArmLanes<lanes>&, const SolverRows&);   \
  template void warm_start(ConstraintBlock<lanes>&, const SolverRows&);                           \
  template void sweep_biased(ConstraintBlock<lanes>&, const SolverRows&, const SoftStep&);        \
  template void sweep_relaxed(ConstraintBlock<lanes>&, const SolverRows&, const SoftStep&);       \
  template void sum_impulses(ConstraintBlock<lanes>&);                                            \
  template void find_work(ConstraintBlock<lanes>&, const SolverRows&);                            \
  template void scale_impulses(ConstraintBlock<lanes>&, ArmLanes<lanes>*, const float*);          \
  template void record_spin_change(const ConstraintBlock<lanes>&, const ArmLanes<lanes>&,         \
                                   const SolverRows&, const float*, float);                       \
  template void save_impulses(const ConstraintBlock<lanes>&, SearchLanes<lanes>&);                \
  template void find_change_energy(const ConstraintBlock<lanes>&, const SearchLanes<lanes>&,      \
                                   float*);                                                       \
  template void step_along_direction(ConstraintBlock<lanes>&, SearchLanes<lanes>&,                \
                                     const SolverRows&, float);                                   \
  template bool apply_restitution(ConstraintBlock<lanes>&, ArmLanes<lanes>&, const SolverRows&,   \
                                  float);                                                         \
  template void extract_contacts(ConstraintBlock<lanes>&, ImpactLanes<lanes>&, ImpactPair*,       \
                                 ImpactContact*);                                                 \
  template void apply_propagation(ConstraintBlock<lanes>&, const ImpactLanes<lanes>&,             \
                                  ImpactContact*, const SolverRows&);                             \
  template bool find_gaps(const ConstraintBlock<lanes>&, ImpactLanes<lanes>&, const SolverRows&,  \
                          float);                                                                 \
  template bool propagate<lanes>(const ImpactPair*, ImpactContact*, std::uint32_t,                \
                                 const SolverRows&, const SoftStep&, const ImpactSweep&);         \
  template void separations_now(const ConstraintBlock<lanes>&, const SolverRows&, float(*)[lanes]);

}  // namespace sunder::solver
