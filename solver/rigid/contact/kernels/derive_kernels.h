// Computes Jacobians and effective masses from the data of prepare.cpp, a manifold per lane. Read
// first: derive(). Included only by sweep_1.cpp and so on, under the rule of sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/kernels/sweep_kernels.h"

namespace sunder::solver {

template <class V>
SUNDER_INLINE V reciprocal(V x) {
  const V zero = {}, one = splat<V>(1);
  return x > zero ? one / (x > zero ? x : one) : zero;
}

/// Response of each body and of both to a unit impulse.
template <class V>
struct Response {
  V a, b;

  SUNDER_INLINE V all() const { return a + b; }
};

/// Scales bodies to the parts that split manifolds move.
template <std::uint32_t lanes>
SUNDER_INLINE void split_bodies(GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  const V one = splat<V>(1), root_a = sqrt(g.parts_a), root_b = sqrt(g.parts_b);
  c.inverse_mass_a *= g.parts_a, c.inverse_mass_b *= g.parts_b;
  for (int k = 0; k < 3; ++k) {
    g.root_a[k] = g.root_a[k] * root_a;
    g.root_b[k] = g.root_b[k] * root_b;
  }
  c.parts.share_a = one / g.parts_a, c.parts.share_b = one / g.parts_b;
  c.parts.root_a = one / root_a, c.parts.root_b = one / root_b;
}

/// Returns the response of bodies over that of their parts.
template <std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> split_scale(const ConstraintBlock<lanes>& c,
                                        const Response<WideOf<lanes>>& parts) {
  return (parts.a * c.parts.share_a + parts.b * c.parts.share_b) * reciprocal(parts.all());
}

template <std::uint32_t lanes>
SUNDER_INLINE void set_tangents(ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1);
  const auto flat = c.normal.x * c.normal.x < splat<V>(0.5f);
  const Wide3Of<lanes> helper = {flat ? one : zero, flat ? zero : one, zero};
  const Wide3Of<lanes> t = cross(c.normal, helper);
  const V square = dot(t, t);
  c.tangent_1 = t * (one / sqrt(square > zero ? square : one));
  c.tangent_2 = cross(c.normal, c.tangent_1);
}

/// Moves the arms of both sides to one point: see ArmLanes.
template <std::uint32_t lanes>
SUNDER_INLINE void close_arms(GatheredBlock<lanes>& g, const ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  g.gap = g.offset + g.friction_arm_b - g.friction_arm_a;
  g.closed_gap = g.gap * g.closes_gap;
  const V by_a = g.closes_gap * g.share_a, by_b = g.closes_gap * (splat<V>(1) - g.share_a);
  const auto close_at = [&](Wide3Of<lanes>& arm_a, Wide3Of<lanes>& arm_b) {
    const Wide3Of<lanes> gap = g.offset + arm_b - arm_a;
    arm_a = arm_a + gap * by_a;
    arm_b = arm_b - gap * by_b;
  };
  close_at(g.friction_arm_a, g.friction_arm_b);
  for (std::uint32_t i = 0; i < c.points; ++i) close_at(g.arm_a[i], g.arm_b[i]);
}

/// Computes the effective masses of friction.
template <std::uint32_t lanes>
SUNDER_INLINE void derive_friction_mass(ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  const V inverse_mass = c.inverse_mass_a + c.inverse_mass_b;
  const V k11 =
      inverse_mass + dot(c.friction_1_a, c.friction_1_a) + dot(c.friction_1_b, c.friction_1_b);
  const V k22 =
      inverse_mass + dot(c.friction_2_a, c.friction_2_a) + dot(c.friction_2_b, c.friction_2_b);
  const V k12 = dot(c.friction_1_a, c.friction_2_a) + dot(c.friction_1_b, c.friction_2_b);
  const V scale = reciprocal(k11 * k22 - k12 * k12);
  c.friction_mass_11 = k22 * scale, c.friction_mass_12 = -k12 * scale,
  c.friction_mass_22 = k11 * scale;
}

/// Computes the compliance of friction on parts over that on bodies.
template <std::uint32_t lanes>
SUNDER_INLINE void derive_friction_split_scale(ConstraintBlock<lanes>& c) {
  const auto of = [](const WideOf<lanes>& inverse_mass, const Wide3Of<lanes>& angular_1,
                     const Wide3Of<lanes>& angular_2) {
    return inverse_mass + inverse_mass + dot(angular_1, angular_1) + dot(angular_2, angular_2);
  };
  c.parts.friction_split_scale =
      split_scale(c, {of(c.inverse_mass_a, c.friction_1_a, c.friction_2_a),
                      of(c.inverse_mass_b, c.friction_1_b, c.friction_2_b)});
}

template <std::uint32_t lanes>
SUNDER_INLINE void derive_friction(const GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  c.friction_1_a = to_root(g.root_a, cross(g.friction_arm_a, c.tangent_1));
  c.friction_1_b = to_root(g.root_b, cross(g.friction_arm_b, c.tangent_1));
  c.friction_2_a = to_root(g.root_a, cross(g.friction_arm_a, c.tangent_2));
  c.friction_2_b = to_root(g.root_b, cross(g.friction_arm_b, c.tangent_2));
  derive_friction_mass(c);
  if (c.split) derive_friction_split_scale(c);
  c.twist_a = to_root(g.root_a, c.normal);
  c.twist_b = to_root(g.root_b, c.normal);
  c.twist_mass = reciprocal(dot(c.twist_a, c.twist_a) + dot(c.twist_b, c.twist_b));
  c.drift_1 = dot(g.drift, c.tangent_1), c.drift_2 = dot(g.drift, c.tangent_2);
  c.friction_impulse_1 = dot(g.friction_impulse, c.tangent_1);
  c.friction_impulse_2 = dot(g.friction_impulse, c.tangent_2);
}

template <std::uint32_t lanes>
SUNDER_INLINE void derive_roll(const GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  RollLanes<lanes>& r = c.roll;
  r.angular_1_a = to_root(g.root_a, c.tangent_1), r.angular_1_b = to_root(g.root_b, c.tangent_1);
  r.angular_2_a = to_root(g.root_a, c.tangent_2), r.angular_2_b = to_root(g.root_b, c.tangent_2);
  const V k11 = dot(r.angular_1_a, r.angular_1_a) + dot(r.angular_1_b, r.angular_1_b);
  const V k22 = dot(r.angular_2_a, r.angular_2_a) + dot(r.angular_2_b, r.angular_2_b);
  const V k12 = dot(r.angular_1_a, r.angular_2_a) + dot(r.angular_1_b, r.angular_2_b);
  const V scale = reciprocal(k11 * k22 - k12 * k12);
  r.mass_11 = k22 * scale, r.mass_12 = -k12 * scale, r.mass_22 = k11 * scale;
  r.impulse_1 = dot(g.roll_impulse, c.tangent_1);
  r.impulse_2 = dot(g.roll_impulse, c.tangent_2);
}

template <std::uint32_t lanes>
SUNDER_INLINE void derive_points(const GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  const V inverse_mass = c.inverse_mass_a + c.inverse_mass_b;
  for (std::uint32_t i = 0; i < c.points; ++i) {
    PointLanes<lanes>& p = c.point[i];
    p.angular_a = to_root(g.root_a, cross(g.arm_a[i], c.normal));
    p.angular_b = to_root(g.root_b, cross(g.arm_b[i], c.normal));
    const Response<V> angular = {dot(p.angular_a, p.angular_a), dot(p.angular_b, p.angular_b)};
    p.mass = reciprocal(inverse_mass + angular.a + angular.b) * g.has[i];
    if (c.split)
      c.parts.normal_split_scale[i] =
          split_scale(c, {c.inverse_mass_a + angular.a, c.inverse_mass_b + angular.b});
    const Wide3Of<lanes> off = g.arm_b[i] - g.friction_arm_b;
    const Wide3Of<lanes> arm = off - c.normal * dot(off, c.normal);
    p.arm = sqrt(dot(arm, arm)) * g.has[1];  // one point alone has no twist
  }
}

template <std::uint32_t lanes>
SUNDER_INLINE void derive_springs(const GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  using V = WideOf<lanes>;
  const V mass = g.normal_mass_scale, softness = g.compliance_scale * g.normal_impulse_scale;
  c.normal_mass_scale = mass / (mass + softness),
  c.normal_impulse_scale = softness / (mass + softness);
  if (!c.split) return;
  for (std::uint32_t i = 0; i < c.points; ++i) c.parts.normal_split_scale[i] *= g.compliance_scale;
}

/// Removes the response of sleeping bodies.
template <std::uint32_t lanes>
SUNDER_INLINE void fix_sleepers(const GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  c.inverse_mass_a *= g.awake_a, c.inverse_mass_b *= g.awake_b;
  auto fix = [&](Wide3Of<lanes>& a, Wide3Of<lanes>& b) { a = a * g.awake_a, b = b * g.awake_b; };
  fix(c.friction_1_a, c.friction_1_b);
  fix(c.friction_2_a, c.friction_2_b);
  fix(c.twist_a, c.twist_b);
  fix(c.roll.angular_1_a, c.roll.angular_1_b);
  fix(c.roll.angular_2_a, c.roll.angular_2_b);
  for (std::uint32_t i = 0; i < c.points; ++i) fix(c.point[i].angular_a, c.point[i].angular_b);
}

template <std::uint32_t lanes>
void derive(GatheredBlock<lanes>& g, ConstraintBlock<lanes>& c) {
  if (c.split) split_bodies(g, c);
  set_tangents(c);
  close_arms(g, c);
  derive_friction(g, c);
  if (c.rolls) derive_roll(g, c);
  derive_points(g, c);
  derive_springs(g, c);
  c.rebound.fall_m_s2 = max(WideOf<lanes>{}, -dot(c.normal, g.gravity));
  if (g.sleepers) fix_sleepers(g, c);
}

/// Jacobians of both bodies along one direction.
template <class V>
struct Reach {
  Triple<V>&a, &b;

  SUNDER_INLINE V with(const Reach& other) const { return dot(a, other.a) + dot(b, other.b); }
  SUNDER_INLINE void add(const Triple<V>& to_a, const Triple<V>& to_b) {
    a = a + to_a, b = b + to_b;
  }
};

/// Moves the arms to bridge the gap in lanes with `where` > 0. All arms of a side move alike, so
/// all Jacobians along one direction change alike. Separations and drifts keep their values; masses
/// change by the change of the moving bodies' response, so that contacts with sleeping bodies keep
/// their softness: see sleep.h.
template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void move_arms(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms,
                             const Wide3Of<lanes>& gap, const Pairs<lanes, kSplit>& x,
                             const WideOf<lanes>& where) {
  using V = WideOf<lanes>;
  using V3 = Wide3Of<lanes>;
  const V zero = {}, one = splat<V>(1);
  arms.pending_a = arms.pending_b = V3{};
  V3 more = gap - arms.closed_gap;
  const V follows = (where > zero) & (dot(more, more) > arms.least) ? one : zero;
  if (!any(follows > zero)) return;
  more = more * follows;
  arms.closed_gap = arms.closed_gap + more;
  const V3 shift_a = more * arms.share_a, shift_b = more * (arms.share_a - one);
  V3 by_a, by_b;
  const auto shift = [&](const V3& direction, const V& impulse) {
    by_a = to_root(arms.root_a, cross(shift_a, direction));
    by_b = to_root(arms.root_b, cross(shift_b, direction));
    arms.pending_a = arms.pending_a + by_a * impulse,
    arms.pending_b = arms.pending_b + by_b * impulse;
    return dot(by_b, x.b.angular) - dot(by_a, x.a.angular);
  };
  const V shifted = shift(c.normal, total_impulse(c));
  for (std::uint32_t i = 0; i < c.points; ++i) {
    PointLanes<lanes>& p = c.point[i];
    Reach<V> reach{p.angular_a, p.angular_b};
    const V was = reach.with(reach);
    reach.add(by_a, by_b);
    p.separation = p.separation - shifted;
    p.mass = p.mass / (one + p.mass * (reach.with(reach) - was));
  }
  Reach<V> friction_1{c.friction_1_a, c.friction_1_b}, friction_2{c.friction_2_a, c.friction_2_b};
  const V was_11 = friction_1.with(friction_1), was_12 = friction_1.with(friction_2),
          was_22 = friction_2.with(friction_2);
  c.drift_1 = c.drift_1 - shift(c.tangent_1, c.friction_impulse_1);
  friction_1.add(by_a, by_b);
  c.drift_2 = c.drift_2 - shift(c.tangent_2, c.friction_impulse_2);
  friction_2.add(by_a, by_b);
  const V scale =
      reciprocal(c.friction_mass_11 * c.friction_mass_22 - c.friction_mass_12 * c.friction_mass_12);
  const V k11 = c.friction_mass_22 * scale + (friction_1.with(friction_1) - was_11);
  const V k12 = (friction_1.with(friction_2) - was_12) - c.friction_mass_12 * scale;
  const V k22 = c.friction_mass_11 * scale + (friction_2.with(friction_2) - was_22);
  const V inverse = reciprocal(k11 * k22 - k12 * k12);
  c.friction_mass_11 = follows > zero ? k22 * inverse : c.friction_mass_11;
  c.friction_mass_12 = follows > zero ? -k12 * inverse : c.friction_mass_12;
  c.friction_mass_22 = follows > zero ? k11 * inverse : c.friction_mass_22;
  arms.has_pending = true;
}

/// Returns the time until the first point touches, for contacts that are apart and have no impulse;
/// 0 if that is after the substep, or if the arms point there already: impacts close their gaps by
/// the end of a substep, and the rest of a gap is rounding.
template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE WideOf<lanes> time_to_touch(const ConstraintBlock<lanes>& c,
                                          const ArmLanes<lanes>& arms,
                                          const Pairs<lanes, kSplit>& x,
                                          const Pairs<lanes, kSplit>& v, float h_s) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1), now = splat<V>(kNegligible * h_s),
          end = splat<V>(h_s) + now;
  V first = total_impulse(c) > zero ? zero : end;
  for (std::uint32_t i = 0; i < c.points; ++i) {
    const PointLanes<lanes>& p = c.point[i];
    const V s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
    const V u = v.along(c.normal, p.angular_a, p.angular_b);
    const V after = s / (u < zero ? -u : one);
    const V meets = s > zero ? (u < zero ? min(first, after) : first) : zero;
    first = p.mass > zero ? meets : first;
  }
  const V aside = dot(c.normal, arms.closed_gap);
  const auto aims = aside * aside < arms.near;
  return (first < end) & ((first > now) | !aims) ? first : zero;
}

template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void update_arms_as(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms,
                                  const SolverRows& bodies, float h_s) {
  using V = WideOf<lanes>;
  const V zero = {}, one = splat<V>(1);
  const Pairs<lanes, kSplit> x(c, bodies, &BodyRow::position);
  arms.moving_impulse = c.normal * total_impulse(c) + c.tangent_1 * c.friction_impulse_1 +
                        c.tangent_2 * c.friction_impulse_2;
  const Wide3Of<lanes> displacement = x.b.linear - x.a.linear;
  Wide3Of<lanes> gap = arms.gap + displacement;
  V wanted = dot(displacement, displacement) > arms.least ? c.point[0].mass : zero;
  const V wide = dot(gap, gap) > arms.wide ? one : zero;
  if (any(wide > zero)) {
    const Pairs<lanes, kSplit> v(c, bodies, &BodyRow::velocity);
    const V after = time_to_touch<kSplit>(c, arms, x, v, h_s) * wide;
    gap = gap + (v.b.linear - v.a.linear) * after;
    wanted = wide > zero ? after : wanted;
  }
  move_arms(c, arms, gap, x, wanted);
}

template <std::uint32_t lanes>
void update_arms(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms, const SolverRows& bodies,
                 float h_s) {
  c.split ? update_arms_as<true>(c, arms, bodies, h_s)
          : update_arms_as<false>(c, arms, bodies, h_s);
}

template <bool kSplit, std::uint32_t lanes>
SUNDER_INLINE void apply_arm_change_as(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms,
                                       const SolverRows& bodies) {
  Pairs<lanes, kSplit> v(c, bodies, &BodyRow::velocity);
  if (arms.has_pending) {
    v.a.angular = v.a.angular - arms.pending_a;
    v.b.angular = v.b.angular + arms.pending_b;
  }
  store(c, v, bodies);
  arms.has_pending = false;
}

template <std::uint32_t lanes>
void apply_arm_change(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms, const SolverRows& bodies) {
  // Every split block stores its changes, or older ones would be summed again.
  if (c.split)
    apply_arm_change_as<true>(c, arms, bodies);
  else if (arms.has_pending)
    apply_arm_change_as<false>(c, arms, bodies);
}

template <std::uint32_t lanes>
void separations_now(const ConstraintBlock<lanes>& c, const SolverRows& bodies,
                     float (*separation)[lanes]) {
  auto write = [&](const auto& x) {
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const PointLanes<lanes>& p = c.point[i];
      const WideOf<lanes> s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
      for (std::uint32_t lane = 0; lane < lanes; ++lane) separation[i][lane] = s[lane];
    }
  };
  if (c.split)
    write(Pairs<lanes, true>(c, bodies, &BodyRow::position));
  else
    write(Pairs<lanes, false>(c, bodies, &BodyRow::position));
}

}  // namespace sunder::solver
