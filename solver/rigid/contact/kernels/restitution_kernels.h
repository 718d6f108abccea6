// Restitution, before the sweeps of a substep: impacts that rebound, one contact after another.
// Read first: apply_restitution(). Included only by sweep_1.cpp and so on, under the rule of
// sweep_kernels.h.
#pragma once

#include "solver/rigid/contact/kernels/derive_kernels.h"

namespace sunder::solver {

/// Rows of the lanes for which `active` is 1; 0 for other lanes.
template <std::uint32_t lanes>
struct ActiveRows {
  std::int32_t a[lanes], b[lanes];

  SUNDER_INLINE ActiveRows(const ConstraintBlock<lanes>& c, const std::int32_t* active) {
    for (std::uint32_t i = 0; i < lanes; ++i)
      a[i] = active[i] * c.row_a[i], b[i] = active[i] * c.row_b[i];
  }
  SUNDER_INLINE void store(const Pairs<lanes, false>& of, const SolverRows& bodies,
                           Wide BodyRow::*member) const {
    store_side<lanes>(of.a, a, bodies.rows, member);
    store_side<lanes>(of.b, b, bodies.rows, member);
  }
};

/// Closing of a contact's points at the start of a substep, after gravity was added.
template <std::uint32_t lanes>
struct Closing {
  using V = WideOf<lanes>;
  /// Closing speeds before gravity; 0: the point does not touch in this substep or the next.
  V speed[4];
  V touch_s;          ///< Time when the first of them touches.
  V rebounding = {};  ///< 1: touches within the substep and rebounds.

  SUNDER_INLINE Closing(const ConstraintBlock<lanes>& c, const Pairs<lanes, false>& x,
                        const Pairs<lanes, false>& v, float h_s)
      : touch_s(splat<V>(2 * h_s)) {
    const V zero = {}, one = splat<V>(1), h = splat<V>(h_s), fall = c.rebound.fall_m_s2;
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const PointLanes<lanes>& p = c.point[i];
      const V s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
      const V u = v.along(c.normal, p.angular_a, p.angular_b), before = -u - fall * h;
      const auto meets = (p.mass > zero) & (before > zero) & (s + splat<V>(2) * u * h < zero);
      const V gap = max(zero, s), square = before * before + splat<V>(2) * fall * gap;
      const V hits = sqrt(meets ? square : one);
      const auto rebounds = meets & (hits > splat<V>(c.rebound.least_m_s)) & (s + u * h < zero);
      speed[i] = meets ? before : zero;
      touch_s = rebounds ? min(touch_s, splat<V>(2) * gap / (before + hits)) : touch_s;
      rebounding = rebounds & (c.rebound.restitution > zero) ? one : rebounding;
    }
  }

  /// Recomputes the closing speeds after the arms moved to the point of contact.
  SUNDER_INLINE void update_speeds(const ConstraintBlock<lanes>& c, const Pairs<lanes, false>& v,
                                   float h_s) {
    const V zero = {};
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const V u = v.along(c.normal, c.point[i].angular_a, c.point[i].angular_b);
      const V before = -u - c.rebound.fall_m_s2 * splat<V>(h_s);
      speed[i] = speed[i] > zero ? max(zero, before) : zero;
    }
  }

  /// Returns the separating speed by Newton's law of impact, at the start of the parabola that the
  /// rebound is part of.
  SUNDER_INLINE V rebound_speed(const ConstraintBlock<lanes>& c, std::uint32_t i, float h_s) const {
    const V fall = c.rebound.fall_m_s2;
    const V hits = speed[i] + fall * touch_s;
    return c.rebound.restitution * hits + fall * (touch_s - splat<V>(h_s));
  }
};

/// Both bodies of a contact that rebounds, and the impulses so far.
template <std::uint32_t lanes>
struct Restitution {
  using V = WideOf<lanes>;
  Pairs<lanes, false> was, now;
  V impulse[4] = {}, friction_1 = {}, friction_2 = {};

  SUNDER_INLINE Restitution(const ConstraintBlock<lanes>& c, const SolverRows& bodies)
      : was(c, bodies, &BodyRow::base), now(was) {}

  SUNDER_INLINE void solve_normal(const ConstraintBlock<lanes>& c, const Closing<lanes>& closing,
                                  float h_s) {
    const V zero = {};
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const PointLanes<lanes>& p = c.point[i];
      const auto meets = (closing.rebounding > zero) & (closing.speed[i] > zero);
      const V change =
          closing.rebound_speed(c, i, h_s) - now.along(c.normal, p.angular_a, p.angular_b);
      const V next = meets ? max(zero, impulse[i] + p.mass * change) : zero;
      now.apply_impulse(c, c.normal, p.angular_a, p.angular_b, next - impulse[i]);
      impulse[i] = next;
    }
  }

  SUNDER_INLINE V load(const ConstraintBlock<lanes>& c) const {
    V sum = impulse[0];
    for (std::uint32_t i = 1; i < c.points; ++i) sum += impulse[i];
    return sum;
  }

  SUNDER_INLINE void solve_friction(const ConstraintBlock<lanes>& c) {
    const V limit = c.friction * load(c);
    const V u1 = now.along(c.tangent_1, c.friction_1_a, c.friction_1_b);
    const V u2 = now.along(c.tangent_2, c.friction_2_a, c.friction_2_b);
    V next_1 = friction_1 - (c.friction_mass_11 * u1 + c.friction_mass_12 * u2);
    V next_2 = friction_2 - (c.friction_mass_12 * u1 + c.friction_mass_22 * u2);
    const V square = next_1 * next_1 + next_2 * next_2;
    const auto slips = square > limit * limit;
    const V scale = slips ? limit / sqrt(slips ? square : splat<V>(1)) : splat<V>(1);
    next_1 *= scale, next_2 *= scale;
    now.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b, next_1 - friction_1);
    now.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b, next_2 - friction_2);
    friction_1 = next_1, friction_2 = next_2;
  }

  /// Returns the scale of the impulses with which they add no energy: Newton's law with friction
  /// may add some (Kane 1984).
  SUNDER_INLINE V energy_scale(const ConstraintBlock<lanes>& c) const {
    const V zero = {};
    V first = zero, both = zero;  // twice the work at the speeds before, and at the mean speeds
    const auto add = [&](const V& pushed, const Wide3Of<lanes>& direction,
                         const Wide3Of<lanes>& on_a, const Wide3Of<lanes>& on_b) {
      const V before = was.along(direction, on_a, on_b), after = now.along(direction, on_a, on_b);
      first += pushed * (before + before), both += pushed * (before + after);
    };
    for (std::uint32_t i = 0; i < c.points; ++i)
      add(impulse[i], c.normal, c.point[i].angular_a, c.point[i].angular_b);
    add(friction_1, c.tangent_1, c.friction_1_a, c.friction_1_b);
    add(friction_2, c.tangent_2, c.friction_2_a, c.friction_2_b);
    const auto gains = (both > zero) & (both - first > zero);
    return gains ? max(zero, -first / (gains ? both - first : splat<V>(1))) : splat<V>(1);
  }

  SUNDER_INLINE void scale(V factor) {
    for (V& of_point : impulse) of_point *= factor;
    friction_1 *= factor, friction_2 *= factor;
  }

  SUNDER_INLINE void apply(const ConstraintBlock<lanes>& c, Pairs<lanes, false>& to,
                           V scale) const {
    for (std::uint32_t i = 0; i < c.points; ++i)
      to.apply_impulse(c, c.normal, c.point[i].angular_a, c.point[i].angular_b, impulse[i] * scale);
    to.apply_impulse(c, c.tangent_1, c.friction_1_a, c.friction_1_b, friction_1 * scale);
    to.apply_impulse(c, c.tangent_2, c.friction_2_a, c.friction_2_b, friction_2 * scale);
  }
};

template <std::uint32_t lanes>
bool apply_restitution(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms, const SolverRows& bodies,
                       float h_s) {
  using V = WideOf<lanes>;
  if (!c.bouncy || c.split) return false;
  constexpr int kRounds = 16;
  const V zero = {}, one = splat<V>(1);
  Pairs<lanes, false> x(c, bodies, &BodyRow::position), v(c, bodies, &BodyRow::velocity);
  Restitution<lanes> restitution(c, bodies);
  Closing<lanes> closing(c, x, restitution.was, h_s);
  if (!any(closing.rebounding > zero)) return false;
  const Wide3Of<lanes> displacement =
      (restitution.was.b.linear - restitution.was.a.linear) * closing.touch_s;
  move_arms(c, arms, arms.gap + (x.b.linear - x.a.linear) + displacement, x, closing.rebounding);
  closing.update_speeds(c, restitution.was, h_s);
  for (int round = 0; round < kRounds; ++round)
    restitution.solve_normal(c, closing, h_s), restitution.solve_friction(c);
  restitution.scale(restitution.energy_scale(c));
  restitution.now = restitution.was;
  restitution.apply(c, restitution.now, one);
  restitution.apply(c, v, one);
  // undoes the displacement up to the contact by the change of speed
  restitution.apply(c, x, -closing.touch_s);
  std::int32_t active[lanes];
  for (std::uint32_t lane = 0; lane < lanes; ++lane) active[lane] = closing.rebounding[lane] > 0;
  const ActiveRows<lanes> to(c, active);
  to.store(v, bodies, &BodyRow::velocity);
  to.store(restitution.now, bodies, &BodyRow::base);
  to.store(x, bodies, &BodyRow::position);
  for (std::uint32_t i = 0; i < c.points; ++i) c.step_impulse[i] += restitution.impulse[i];
  c.step_impulse[4] += restitution.friction_1, c.step_impulse[5] += restitution.friction_2;
  return true;
}

}  // namespace sunder::solver
