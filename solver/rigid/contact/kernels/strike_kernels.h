// Restitution, before the sweeps of a substep: impacts that rebound, one contact after another.
// Read first: strike(). Included only by sweep_1.cpp and so on, under the rule of sweep_kernels.h.
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
struct Meeting {
  using V = WideOf<lanes>;
  /// Closing speeds before gravity; 0: the point does not touch in this substep or the next.
  V closes[4];
  V meets_s;      ///< Time when the first of them touches.
  V struck = {};  ///< 1: touches within the substep and rebounds.

  SUNDER_INLINE Meeting(const ConstraintBlock<lanes>& c, const Pairs<lanes, false>& x,
                        const Pairs<lanes, false>& v, float h_s)
      : meets_s(splat<V>(2 * h_s)) {
    const V zero = {}, one = splat<V>(1), h = splat<V>(h_s), fall = c.rebound.fall_m_s2;
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const PointLanes<lanes>& p = c.point[i];
      const V s = p.separation + x.along(c.normal, p.angular_a, p.angular_b);
      const V u = v.along(c.normal, p.angular_a, p.angular_b), before = -u - fall * h;
      const auto meets = (p.mass > zero) & (before > zero) & (s + splat<V>(2) * u * h < zero);
      const V gap = max(zero, s), square = before * before + splat<V>(2) * fall * gap;
      const V hits = sqrt(meets ? square : one);
      const auto rebounds = meets & (hits > splat<V>(c.rebound.least_m_s)) & (s + u * h < zero);
      closes[i] = meets ? before : zero;
      meets_s = rebounds ? min(meets_s, splat<V>(2) * gap / (before + hits)) : meets_s;
      struck = rebounds & (c.rebound.restitution > zero) ? one : struck;
    }
  }

  /// Recomputes the closing speeds after the arms moved to the point of contact.
  SUNDER_INLINE void close(const ConstraintBlock<lanes>& c, const Pairs<lanes, false>& v,
                           float h_s) {
    const V zero = {};
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const V u = v.along(c.normal, c.point[i].angular_a, c.point[i].angular_b);
      const V before = -u - c.rebound.fall_m_s2 * splat<V>(h_s);
      closes[i] = closes[i] > zero ? max(zero, before) : zero;
    }
  }

  /// Returns the separating speed by Newton's law of impact, at the start of the parabola that the
  /// rebound is part of.
  SUNDER_INLINE V leaves(const ConstraintBlock<lanes>& c, std::uint32_t i, float h_s) const {
    const V fall = c.rebound.fall_m_s2;
    const V hits = closes[i] + fall * meets_s;
    return c.rebound.restitution * hits + fall * (meets_s - splat<V>(h_s));
  }
};

/// Both bodies of a contact that rebounds, and the impulses so far.
template <std::uint32_t lanes>
struct Strike {
  using V = WideOf<lanes>;
  Pairs<lanes, false> was, now;
  V impulse[4] = {}, slide_1 = {}, slide_2 = {};

  SUNDER_INLINE Strike(const ConstraintBlock<lanes>& c, const SolverRows& bodies)
      : was(c, bodies, &BodyRow::base), now(was) {}

  SUNDER_INLINE void press(const ConstraintBlock<lanes>& c, const Meeting<lanes>& meeting,
                           float h_s) {
    const V zero = {};
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const PointLanes<lanes>& p = c.point[i];
      const auto meets = (meeting.struck > zero) & (meeting.closes[i] > zero);
      const V change = meeting.leaves(c, i, h_s) - now.along(c.normal, p.angular_a, p.angular_b);
      const V next = meets ? max(zero, impulse[i] + p.mass * change) : zero;
      now.push(c, c.normal, p.angular_a, p.angular_b, next - impulse[i]);
      impulse[i] = next;
    }
  }

  SUNDER_INLINE V load(const ConstraintBlock<lanes>& c) const {
    V sum = impulse[0];
    for (std::uint32_t i = 1; i < c.points; ++i) sum += impulse[i];
    return sum;
  }

  SUNDER_INLINE void slide(const ConstraintBlock<lanes>& c) {
    const V limit = c.friction * load(c);
    const V u1 = now.along(c.tangent_1, c.slide_1_a, c.slide_1_b);
    const V u2 = now.along(c.tangent_2, c.slide_2_a, c.slide_2_b);
    V next_1 = slide_1 - (c.slide_11 * u1 + c.slide_12 * u2);
    V next_2 = slide_2 - (c.slide_12 * u1 + c.slide_22 * u2);
    const V square = next_1 * next_1 + next_2 * next_2;
    const auto slips = square > limit * limit;
    const V scale = slips ? limit / sqrt(slips ? square : splat<V>(1)) : splat<V>(1);
    next_1 *= scale, next_2 *= scale;
    now.push(c, c.tangent_1, c.slide_1_a, c.slide_1_b, next_1 - slide_1);
    now.push(c, c.tangent_2, c.slide_2_a, c.slide_2_b, next_2 - slide_2);
    slide_1 = next_1, slide_2 = next_2;
  }

  /// Returns the scale of the impulses with which they add no energy: Newton's law with friction
  /// may add some (Kane 1984).
  SUNDER_INLINE V share(const ConstraintBlock<lanes>& c) const {
    const V zero = {};
    V first = zero, both = zero;  // twice the work at the speeds before, and at the mean speeds
    const auto add = [&](const V& pushed, const Wide3Of<lanes>& direction,
                         const Wide3Of<lanes>& on_a, const Wide3Of<lanes>& on_b) {
      const V before = was.along(direction, on_a, on_b), after = now.along(direction, on_a, on_b);
      first += pushed * (before + before), both += pushed * (before + after);
    };
    for (std::uint32_t i = 0; i < c.points; ++i)
      add(impulse[i], c.normal, c.point[i].angular_a, c.point[i].angular_b);
    add(slide_1, c.tangent_1, c.slide_1_a, c.slide_1_b);
    add(slide_2, c.tangent_2, c.slide_2_a, c.slide_2_b);
    const auto gains = (both > zero) & (both - first > zero);
    return gains ? max(zero, -first / (gains ? both - first : splat<V>(1))) : splat<V>(1);
  }

  SUNDER_INLINE void scale(V share) {
    for (V& of_point : impulse) of_point *= share;
    slide_1 *= share, slide_2 *= share;
  }

  SUNDER_INLINE void apply(const ConstraintBlock<lanes>& c, Pairs<lanes, false>& to,
                           V scale) const {
    for (std::uint32_t i = 0; i < c.points; ++i)
      to.push(c, c.normal, c.point[i].angular_a, c.point[i].angular_b, impulse[i] * scale);
    to.push(c, c.tangent_1, c.slide_1_a, c.slide_1_b, slide_1 * scale);
    to.push(c, c.tangent_2, c.slide_2_a, c.slide_2_b, slide_2 * scale);
  }
};

template <std::uint32_t lanes>
bool strike(ConstraintBlock<lanes>& c, ArmLanes<lanes>& arms, const SolverRows& bodies, float h_s) {
  using V = WideOf<lanes>;
  if (!c.bouncy || c.split) return false;
  constexpr int kRounds = 16;
  const V zero = {}, one = splat<V>(1);
  Pairs<lanes, false> x(c, bodies, &BodyRow::position), v(c, bodies, &BodyRow::velocity);
  Strike<lanes> strike(c, bodies);
  Meeting<lanes> meeting(c, x, strike.was, h_s);
  if (!any(meeting.struck > zero)) return false;
  const Wide3Of<lanes> way = (strike.was.b.linear - strike.was.a.linear) * meeting.meets_s;
  bridge(c, arms, arms.gap + (x.b.linear - x.a.linear) + way, x, meeting.struck);
  meeting.close(c, strike.was, h_s);
  for (int round = 0; round < kRounds; ++round) strike.press(c, meeting, h_s), strike.slide(c);
  strike.scale(strike.share(c));
  strike.now = strike.was;
  strike.apply(c, strike.now, one);
  strike.apply(c, v, one);
  // undoes the displacement up to the contact by the change of speed
  strike.apply(c, x, -meeting.meets_s);
  std::int32_t active[lanes];
  for (std::uint32_t lane = 0; lane < lanes; ++lane) active[lane] = meeting.struck[lane] > 0;
  const ActiveRows<lanes> to(c, active);
  to.store(v, bodies, &BodyRow::velocity);
  to.store(strike.now, bodies, &BodyRow::base);
  to.store(x, bodies, &BodyRow::position);
  for (std::uint32_t i = 0; i < c.points; ++i) c.step_impulse[i] += strike.impulse[i];
  c.step_impulse[4] += strike.slide_1, c.step_impulse[5] += strike.slide_2;
  return true;
}

}  // namespace sunder::solver
