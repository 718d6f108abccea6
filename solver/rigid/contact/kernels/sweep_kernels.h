// Projected Gauss-Seidel on soft contacts, with friction and twist at the mean of the points, a
// manifold per lane. Read first: sweep(). Included only by sweep_1.cpp and so on: everything here
// is a template of the number of lanes or inlined by force, or code for one instruction set would
// replace that of another.
#pragma once

#include "solver/rigid/contact/kernels/sweep.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {

template <class V>
SUNDER_INLINE Triple<V> to_root(const Triple<V> (&column)[3], const Triple<V>& angular) {
  return {dot(column[0], angular), dot(column[1], angular), dot(column[2], angular)};
}

/// Velocities of both bodies in each lane; of a split block, of the lane's own parts.
template <std::uint32_t lanes, bool kSplit>
struct Pairs {
  using V = WideOf<lanes>;
  using V3 = Wide3Of<lanes>;
  Motion6<V> a, b;

  SUNDER_INLINE Pairs(const ConstraintBlock<lanes>& c, const SolverRows& bodies,
                      Wide BodyRow::*member)
      : a(load(bodies.rows, c.row_a, member)), b(load(bodies.rows, c.row_b, member)) {
    if constexpr (kSplit) {
      a.angular = a.angular * c.parts.root_a;
      b.angular = b.angular * c.parts.root_b;
    }
  }
  SUNDER_INLINE static Motion6<V> load(const BodyRow* rows, const std::int32_t* index,
                                       Wide BodyRow::*member) {
    const float* row[lanes];
    for (std::uint32_t i = 0; i < lanes; ++i)
      row[i] = reinterpret_cast<const float*>(&(rows[index[i]].*member));
    return load_rows<V>(row);
  }
  SUNDER_INLINE V along(const V3& direction, const V3& angular_a, const V3& angular_b) const {
    return dot(direction, b.linear - a.linear) + dot(angular_b, b.angular) -
           dot(angular_a, a.angular);
  }
  SUNDER_INLINE void apply_impulse(const ConstraintBlock<lanes>& c, const V3& direction,
                                   const V3& angular_a, const V3& angular_b, V impulse) {
    a.linear = a.linear - direction * (impulse * c.inverse_mass_a);
    b.linear = b.linear + direction * (impulse * c.inverse_mass_b);
    a.angular = a.angular - angular_a * impulse;
    b.angular = b.angular + angular_b * impulse;
  }
  SUNDER_INLINE void apply_twist(const ConstraintBlock<lanes>& c, V impulse) {
    a.angular = a.angular - c.twist_a * impulse;
    b.angular = b.angular + c.twist_b * impulse;
  }
};

/// Memory for lanes that store nothing, which avoids a branch per lane.
struct alignas(32) UnusedRow {
  float lane[8];
};

template <std::uint32_t lanes>
SUNDER_INLINE void store_side(const Motion6<WideOf<lanes>>& v, const std::int32_t* index,
                              BodyRow* rows, Wide BodyRow::*member = &BodyRow::velocity) {
  float* row[lanes];
  UnusedRow none;
  for (std::uint32_t i = 0; i < lanes; ++i)
    row[i] = index[i] > 0 ? reinterpret_cast<float*>(&(rows[index[i]].*member)) : none.lane;
  store_rows(v, row);
}

/// Stores the change of a part as its contribution to the average over the body's parts.
template <std::uint32_t lanes>
SUNDER_INLINE void store_part(const Motion6<WideOf<lanes>>& v, const Motion6<WideOf<lanes>>& was,
                              WideOf<lanes> share, WideOf<lanes> root, const std::int32_t* index,
                              const std::uint32_t* part, Wide* parts) {
  const Motion6<WideOf<lanes>> change = {(v.linear - was.linear) * share,
                                         (v.angular - was.angular) * root};
  float* row[lanes];
  UnusedRow none;
  for (std::uint32_t i = 0; i < lanes; ++i)
    row[i] = index[i] > 0 ? reinterpret_cast<float*>(&parts[part[i]]) : none.lane;
  store_rows(change, row);
}

/// Stores new velocities in the bodies, or their changes in the parts to be summed.
template <std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void store(const ConstraintBlock<lanes>& c, const Pairs<lanes, kSplit>& v,
                         const SolverRows& bodies) {
  if constexpr (kSplit) {
    const Pairs<lanes, true> was(c, bodies, &BodyRow::velocity);
    const SplitLanes<lanes>& p = c.parts;
    store_part<lanes>(v.a, was.a, p.share_a, p.root_a, c.row_a, p.part_a, bodies.parts);
    store_part<lanes>(v.b, was.b, p.share_b, p.root_b, c.row_b, p.part_b, bodies.parts);
  } else {
    store_side<lanes>(v.a, c.row_a, bodies.rows);
    store_side<lanes>(v.b, c.row_b, bodies.rows);
  }
}

template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> total_impulse(const ConstraintBlock<lanes>& c) {
  WideOf<lanes> sum = c.point[0].impulse;
  for (std::uint32_t i = 1; i < c.points; ++i) sum += c.point[i].impulse;
  return sum;
}

/// Mass and impulse scales of a spring. Parts are more compliant than bodies: `split_scale` keeps
/// the spring between them, so that splitting changes the convergence and not the solution.
template <class V>
struct Spring {
  V mass_scale, impulse_scale;

  SUNDER_INLINE Spring split(V split_scale) const {
    const V impulse = split_scale * impulse_scale, scale = mass_scale + impulse;
    return {mass_scale / scale, impulse / scale};
  }
};

/// The softness of each lane, that of an edge or of a face.
template <class V>
struct SoftLanes {
  V rate;
  Spring<V> spring;

  SUNDER_INLINE SoftLanes(V face, const Softness& of_edge, const Softness& of_face) {
    const auto is_face = face > V{};
    const auto pick = [&](float one, float other) {
      return is_face ? splat<V>(other) : splat<V>(one);
    };
    rate = pick(of_edge.rate, of_face.rate);
    spring.mass_scale = pick(of_edge.mass_scale, of_face.mass_scale);
    spring.impulse_scale = pick(of_edge.impulse_scale, of_face.impulse_scale);
  }
};

/// Solves Coulomb friction at the mean of the points, in both directions at once, limited to a
/// circle.
template <bool kBiased, std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void solve_friction(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v,
                                  const Pairs<lanes, kSplit>& x, const SoftStep& soft) {
  using V = WideOf<lanes>;
  const V limit = c.friction * total_impulse(c);
  V u1 = v.along(c.tangent_1, c.friction_1_a, c.friction_1_b);
  V u2 = v.along(c.tangent_2, c.friction_2_a, c.friction_2_b);
  const SoftLanes<V> stick(c.face, soft.edge.friction, soft.face.friction);
  if constexpr (kBiased) {
    u1 += stick.rate * (c.drift_1 + x.along(c.tangent_1, c.friction_1_a, c.friction_1_b));
    u2 += stick.rate * (c.drift_2 + x.along(c.tangent_2, c.friction_2_a, c.friction_2_b));
  }
  V d1 = -(c.friction_mass_11 * u1 + c.friction_mass_12 * u2),
    d2 = -(c.friction_mass_12 * u1 + c.friction_mass_22 * u2);
  if constexpr (kBiased) {
    Spring<V> spring = stick.spring;
    if constexpr (kSplit) spring = spring.split(c.parts.friction_split_scale);
    d1 = d1 * spring.mass_scale - c.friction_impulse_1 * spring.impulse_scale;
    d2 = d2 * spring.mass_scale - c.friction_impulse_2 * spring.impulse_scale;
  }
  V new_1 = c.friction_impulse_1 + soft.omega * d1, new_2 = c.friction_impulse_2 + soft.omega * d2;
  const V square = new_1 * new_1 + new_2 * new_2;
  const auto sliding = square > limit * limit;
  const V scale = sliding ? limit / sqrt(sliding ? square : splat<V>(1)) : splat<V>(1);
  new_1 *= scale, new_2 *= scale;
  v.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b, new_1 - c.friction_impulse_1);
  v.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b, new_2 - c.friction_impulse_2);
  c.friction_impulse_1 = new_1, c.friction_impulse_2 = new_2;
}

/// Solves friction against rotation about the normal; the limit is the moment of the loaded points
/// about their mean.
template <std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void solve_twist(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v) {
  using V = WideOf<lanes>;
  V moment = c.point[0].impulse * c.point[0].arm;
  for (std::uint32_t i = 1; i < c.points; ++i) moment += c.point[i].impulse * c.point[i].arm;
  const V limit = c.friction * moment;
  const V u = dot(c.twist_b, v.b.angular) - dot(c.twist_a, v.a.angular);
  const V next = max(-limit, min(limit, c.twist_impulse - c.twist_mass * u));
  v.apply_twist(c, next - c.twist_impulse);
  c.twist_impulse = next;
}

/// Applies angular impulses about the two tangents.
template <std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void apply_rolling(const ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v,
                                 WideOf<lanes> impulse_1, WideOf<lanes> impulse_2) {
  const RollLanes<lanes>& r = c.roll;
  v.a.angular = v.a.angular - r.angular_1_a * impulse_1 - r.angular_2_a * impulse_2;
  v.b.angular = v.b.angular + r.angular_1_b * impulse_1 + r.angular_2_b * impulse_2;
}

/// Solves rolling resistance: a torque about the tangents of at most its lever arm times the normal
/// impulse.
template <std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void solve_rolling(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v) {
  using V = WideOf<lanes>;
  RollLanes<lanes>& r = c.roll;
  const V limit = r.arm * total_impulse(c);
  const V u1 = dot(r.angular_1_b, v.b.angular) - dot(r.angular_1_a, v.a.angular);
  const V u2 = dot(r.angular_2_b, v.b.angular) - dot(r.angular_2_a, v.a.angular);
  V new_1 = r.impulse_1 - (r.mass_11 * u1 + r.mass_12 * u2);
  V new_2 = r.impulse_2 - (r.mass_12 * u1 + r.mass_22 * u2);
  const V square = new_1 * new_1 + new_2 * new_2;
  const auto rolling = square > limit * limit;
  const V scale = rolling ? limit / sqrt(rolling ? square : splat<V>(1)) : splat<V>(1);
  new_1 *= scale, new_2 *= scale;
  apply_rolling(c, v, new_1 - r.impulse_1, new_2 - r.impulse_2);
  r.impulse_1 = new_1, r.impulse_2 = new_2;
}

template <bool kBiased, std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void solve_normal(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v,
                                const Pairs<lanes, kSplit>& x, const SoftStep& soft) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1);
  const SoftLanes<V> springs(c.face, soft.edge.normal, soft.face.normal);
  for (std::uint32_t i = 0; i < c.points; ++i) {
    PointLanes<lanes>& p = c.point[i];
    const V s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
    const auto apart = s > zero;
    V u = v.along(c.normal, p.angular_a, p.angular_b);
    V change;
    if constexpr (kBiased) {
      const V free = u;
      u += s * (apart ? splat<V>(soft.inverse_h) : springs.rate);
      Spring<V> spring{c.normal_mass_scale, c.normal_impulse_scale};
      if constexpr (kSplit) spring = springs.spring.split(c.parts.normal_split_scale[i]);
      const V mass_scale = apart ? one : spring.mass_scale;
      const V impulse_scale = apart ? zero : spring.impulse_scale;
      change = -p.mass * mass_scale * u - impulse_scale * p.impulse;
      // A loaded point is a spring; an overlap without load is corrected at most at this speed.
      const V push = p.mass * mass_scale * (c.push_m_s - free);
      change = apart ? change : min(change, push);
    } else {
      u += apart ? s * soft.inverse_h : zero;
      change = -p.mass * u;
      // A point that is yet to rebound is left to the restitution of the next substep.
      if (c.bouncy) {
        const auto rebounds = apart & (c.rebound.restitution > zero);
        change = rebounds ? (p.impulse > zero ? change : zero) : change;
      }
    }
    const V next = max(zero, p.impulse + soft.omega * change);
    v.apply_impulse(c, c.normal, p.angular_a, p.angular_b, next - p.impulse);
    p.impulse = next;
  }
}

/// Excess over the limit of friction that is kept, since rounding would make it come and go.
constexpr float kFrictionSlack = 0.01f;

/// Removes friction beyond the limit by the final normal impulses.
template <std::uint32_t lanes, bool kSplit>
SUNDER_INLINE void clamp_friction(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v) {
  using V = WideOf<lanes>;
  const V one = splat<V>(1), limit = c.friction * total_impulse(c);
  const V square =
      c.friction_impulse_1 * c.friction_impulse_1 + c.friction_impulse_2 * c.friction_impulse_2;
  const auto beyond = square > splat<V>(1 + 2 * kFrictionSlack) * limit * limit;
  if (!any(beyond)) return;
  const V scale = beyond ? limit / sqrt(beyond ? square : one) : one;
  v.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b,
                  c.friction_impulse_1 * (scale - one));
  v.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b,
                  c.friction_impulse_2 * (scale - one));
  c.friction_impulse_1 *= scale, c.friction_impulse_2 *= scale;
}

/// Solves friction, and what limits rotation by it.
template <bool kBiased, bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void solve_tangents(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v,
                                  const Pairs<lanes, kSplit>& x, const SoftStep& soft) {
  solve_friction<kBiased>(c, v, x, soft);
  if (c.points > 1) solve_twist(c, v);
  if (c.rolls) solve_rolling(c, v);
}

/// Calls visit(slot, impulse) for each impulse of a block, those of rolling last.
template <std::uint32_t lanes, class Visit>
SUNDER_INLINE void for_all_impulses(ConstraintBlock<lanes>& c, const Visit& visit) {
  for (std::uint32_t i = 0; i < c.points; ++i) visit(i, c.point[i].impulse);
  visit(4, c.friction_impulse_1);
  visit(5, c.friction_impulse_2);
  visit(6, c.twist_impulse);
  visit(7, c.roll.impulse_1);
  visit(8, c.roll.impulse_2);
}

/// Velocities and impulses of a block.
template <std::uint32_t lanes, bool kSplit>
struct ContactState {
  using V = WideOf<lanes>;
  Pairs<lanes, kSplit> velocities;
  V impulse[9];

  SUNDER_INLINE ContactState(ConstraintBlock<lanes>& c, const Pairs<lanes, kSplit>& v)
      : velocities(v) {
    for_all_impulses(c, [&](std::uint32_t slot, const V& now) { impulse[slot] = now; });
  }
  /// Restores the lanes in which `changes` is 0.
  SUNDER_INLINE void restore_unless(const V& changes, ConstraintBlock<lanes>& c,
                                    Pairs<lanes, kSplit>& v) const {
    const auto select = [&](V& to, const V& was) { to = changes > V{} ? to : was; };
    const auto select_3 = [&](Triple<V>& to, const Triple<V>& was) {
      select(to.x, was.x), select(to.y, was.y), select(to.z, was.z);
    };
    for_all_impulses(c, [&](std::uint32_t slot, V& to) { select(to, impulse[slot]); });
    select_3(v.a.linear, velocities.a.linear), select_3(v.a.angular, velocities.a.angular);
    select_3(v.b.linear, velocities.b.linear), select_3(v.b.angular, velocities.b.angular);
  }
};

/// Returns 1 for lanes in which a sweep has changed the speed of the bodies by more than it does in
/// a contact at rest; `before` is the normal impulse before the sweep.
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> find_landings(const ConstraintBlock<lanes>& c,
                                          const WideOf<lanes>& before, const SoftStep& soft) {
  using V = WideOf<lanes>;
  const V gained = total_impulse(c) - before;
  return gained * (c.inverse_mass_a + c.inverse_mass_b) > splat<V>(soft.landing_m_s) ? splat<V>(1)
                                                                                     : V{};
}

/// Solves the lanes in which `lands` is 1 again until their points no longer close: friction did
/// not know its limit before, and the friction of a landing tilts a body onto some of its points.
template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void solve_landings(ConstraintBlock<lanes>& c, Pairs<lanes, kSplit>& v,
                                  const Pairs<lanes, kSplit>& x, const SoftStep& soft,
                                  WideOf<lanes> lands) {
  using V = WideOf<lanes>;
  for (int round = 0; round < kLandingRounds && any(lands > V{}); ++round) {
    const ContactState<lanes, kSplit> was(c, v);
    solve_normal<false>(c, v, x, soft);
    solve_tangents<false>(c, v, x, soft);
    was.restore_unless(lands, c, v);
    V changed = {};
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const V change = c.point[i].impulse - was.impulse[i];
      const auto much = max(change, -change) > splat<V>(soft.landing_m_s) * c.point[i].mass;
      changed = much ? splat<V>(1) : changed;
    }
    lands = changed;
  }
}

template <bool kBiased, bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void sweep(ConstraintBlock<lanes>& c, const SolverRows& bodies,
                         const SoftStep& soft) {
  Pairs<lanes, kSplit> v(c, bodies, &BodyRow::velocity);
  const Pairs<lanes, kSplit> x(c, bodies, &BodyRow::position);
  const WideOf<lanes> before = total_impulse(c);
  solve_tangents<kBiased>(c, v, x, soft);
  solve_normal<kBiased>(c, v, x, soft);
  const WideOf<lanes> lands = find_landings(c, before, soft);
  if constexpr (kBiased) {
    if (any(lands > WideOf<lanes>{})) {
      const ContactState<lanes, kSplit> was(c, v);
      solve_tangents<true>(c, v, x, soft);
      was.restore_unless(lands, c, v);
    }
  } else {
    solve_landings(c, v, x, soft, lands);
    clamp_friction(c, v);
  }
  store(c, v, bodies);
}

template <std::uint32_t lanes>
void sweep_biased(ConstraintBlock<lanes>& c, const SolverRows& bodies, const SoftStep& soft) {
  c.split ? sweep<true, true>(c, bodies, soft) : sweep<true, false>(c, bodies, soft);
}

template <std::uint32_t lanes>
void sweep_relaxed(ConstraintBlock<lanes>& c, const SolverRows& bodies, const SoftStep& soft) {
  c.split ? sweep<false, true>(c, bodies, soft) : sweep<false, false>(c, bodies, soft);
}

/// Returns the scale of the impulses on a lane's bodies.
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> scale_of(const ConstraintBlock<lanes>& c, const float* scale_of_row) {
  WideOf<lanes> share = {};
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    share[lane] = scale_of_row[c.row_a[lane] > 0 ? c.row_a[lane] : c.row_b[lane]];
  return share;
}

template <std::uint32_t lanes>
void record_spin_change(const ConstraintBlock<lanes>& c, const ArmLanes<lanes>& arms,
                        const SolverRows& bodies, const float* scale_of_row, float h_s) {
  using V = WideOf<lanes>;
  if (c.split) return;
  const V removed = splat<V>(h_s) * (splat<V>(1) - scale_of<lanes>(c, scale_of_row));
  if (!any(removed > V{})) return;
  const Pairs<lanes, false> base(c, bodies, &BodyRow::base);
  const Wide3Of<lanes> spin = cross(base.b.linear - base.a.linear, arms.moving_impulse) * removed;
  const Wide3Of<lanes> by_a = to_root(arms.root_a, spin), by_b = to_root(arms.root_b, spin);
  // The split between the bodies needs the least energy.
  const V of_a = dot(by_a, by_a), of_b = dot(by_b, by_b), both = of_a + of_b;
  const V all = both > V{} ? both : splat<V>(1);
  const auto add = [&](const std::int32_t* row, const Wide3Of<lanes>& by, const V& share) {
    const V x = by.x * share, y = by.y * share, z = by.z * share;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      if (row[lane] <= 0) continue;
      Wide& to = bodies.spins[row[lane]];
      to[3] += x[lane], to[4] += y[lane], to[5] += z[lane];
    }
  };
  add(c.row_a, by_a, of_b / all);
  add(c.row_b, by_b, of_a / all);
}

template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void warm_start_as(ConstraintBlock<lanes>& c, const SolverRows& bodies) {
  Pairs<lanes, kSplit> v(c, bodies, &BodyRow::velocity);
  v.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b, c.friction_impulse_1);
  v.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b, c.friction_impulse_2);
  v.apply_twist(c, c.twist_impulse);
  if (c.rolls) apply_rolling(c, v, c.roll.impulse_1, c.roll.impulse_2);
  for (std::uint32_t i = 0; i < c.points; ++i)
    v.apply_impulse(c, c.normal, c.point[i].angular_a, c.point[i].angular_b, c.point[i].impulse);
  store(c, v, bodies);
}

template <std::uint32_t lanes>
void warm_start(ConstraintBlock<lanes>& c, const SolverRows& bodies) {
  c.split ? warm_start_as<true>(c, bodies) : warm_start_as<false>(c, bodies);
}

/// Calls visit(slot, impulse, mass) for each impulse of a block but those of rolling.
template <class Block, class Visit>
SUNDER_INLINE void for_impulses(Block& c, const Visit& visit) {
  for (std::uint32_t i = 0; i < c.points; ++i) visit(i, c.point[i].impulse, c.point[i].mass);
  visit(4, c.friction_impulse_1, c.friction_mass_11);
  visit(5, c.friction_impulse_2, c.friction_mass_22);
  visit(6, c.twist_impulse, c.twist_mass);
}

template <std::uint32_t lanes>
void save_impulses(const ConstraintBlock<lanes>& c, SearchLanes<lanes>& search) {
  for_impulses(c, [&](std::uint32_t slot, const WideOf<lanes>& impulse, const WideOf<lanes>&) {
    search.start[slot] = impulse;
  });
}

template <std::uint32_t lanes>
void find_change_energy(const ConstraintBlock<lanes>& c, const SearchLanes<lanes>& search,
                        float* energy) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1);
  V sum = zero;
  for_impulses(c, [&](std::uint32_t slot, const V& impulse, const V& mass) {
    const V change = impulse - search.start[slot];
    const auto moves = mass > zero;
    sum += moves ? change * change / (moves ? mass : one) : zero;
  });
  for (std::uint32_t lane = 0; lane < lanes; ++lane) energy[lane] = sum[lane];
}

template <std::uint32_t lanes>
void step_along_direction(ConstraintBlock<lanes>& c, SearchLanes<lanes>& search,
                          const SolverRows& bodies, float beta) {
  using V = WideOf<lanes>;
  V step[7] = {};
  for_impulses(c, [&](std::uint32_t slot, V& impulse, const V&) {
    step[slot] = beta * search.direction[slot];
    search.direction[slot] = step[slot] + (impulse - search.start[slot]);
    impulse += step[slot];
  });
  Pairs<lanes, false> v(c, bodies, &BodyRow::velocity);
  v.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b, step[4]);
  v.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b, step[5]);
  v.apply_twist(c, step[6]);
  for (std::uint32_t i = 0; i < c.points; ++i)
    v.apply_impulse(c, c.normal, c.point[i].angular_a, c.point[i].angular_b, step[i]);
  store(c, v, bodies);
}

}  // namespace sunder::solver
