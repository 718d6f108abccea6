// Projected Gauss-Seidel on soft contacts, central friction and twist, eight manifolds at a time.
#include "solver/rigid/sweep.h"

namespace sunder::solver {
namespace {

struct BodyLanes {
  Wide3 linear, angular;
};

BodyLanes load(const BodyRow* rows, const std::int32_t* index, Wide BodyRow::*member) {
  Wide m[8];
  for (std::uint32_t i = 0; i < kLanes; ++i) m[i] = rows[index[i]].*member;
  transpose(m);
  return {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}};
}

void store_velocity(const BodyLanes& v, const std::int32_t* index, BodyRow* rows) {
  Wide m[8] = {v.linear.x,  v.linear.y,  v.linear.z, v.angular.x,
               v.angular.y, v.angular.z, splat(0),   splat(0)};
  transpose(m);
  for (std::uint32_t i = 0; i < kLanes; ++i)
    if (index[i] != 0) rows[index[i]].velocity = m[i];
}

/// Both bodies of every lane.
struct Motion {
  BodyLanes a, b;

  Motion(const ConstraintBlock& c, const BodyRow* rows, Wide BodyRow::*member)
      : a(load(rows, c.row_a, member)), b(load(rows, c.row_b, member)) {}
  Wide along(const Wide3& direction, const Wide3& turn_a, const Wide3& turn_b) const {
    return dot(direction, b.linear - a.linear) + dot(turn_b, b.angular) - dot(turn_a, a.angular);
  }
  void push(const ConstraintBlock& c, const Wide3& direction, const Wide3& turn_a,
            const Wide3& turn_b, Wide impulse) {
    a.linear = a.linear - direction * (impulse * c.inverse_mass_a);
    b.linear = b.linear + direction * (impulse * c.inverse_mass_b);
    a.angular = a.angular - turn_a * impulse;
    b.angular = b.angular + turn_b * impulse;
  }
  void twist(const ConstraintBlock& c, Wide impulse) {
    a.angular = a.angular - c.twist_a * impulse;
    b.angular = b.angular + c.twist_b * impulse;
  }
};

Wide total_impulse(const ConstraintBlock& c) {
  Wide sum = c.point[0].impulse;
  for (int i = 1; i < c.points; ++i) sum += c.point[i].impulse;
  return sum;
}

/// Coulomb friction at the middle of the patch, both directions at once, limited to a circle.
template <bool kBiased>
void slide(ConstraintBlock& c, Motion& v, const Motion& x, const SoftStep& soft) {
  const Wide limit = c.friction * total_impulse(c);
  const Softness& stick = soft.slide[c.points - 1];
  Wide u1 = v.along(c.tangent_1, c.slide_1_a, c.slide_1_b);
  Wide u2 = v.along(c.tangent_2, c.slide_2_a, c.slide_2_b);
  if constexpr (kBiased) {
    u1 += stick.rate * (c.drift_1 + x.along(c.tangent_1, c.slide_1_a, c.slide_1_b));
    u2 += stick.rate * (c.drift_2 + x.along(c.tangent_2, c.slide_2_a, c.slide_2_b));
  }
  Wide d1 = -(c.slide_11 * u1 + c.slide_12 * u2), d2 = -(c.slide_12 * u1 + c.slide_22 * u2);
  if constexpr (kBiased) {
    d1 = d1 * stick.mass_scale - c.slide_impulse_1 * stick.impulse_scale;
    d2 = d2 * stick.mass_scale - c.slide_impulse_2 * stick.impulse_scale;
  }
  Wide new_1 = c.slide_impulse_1 + d1, new_2 = c.slide_impulse_2 + d2;
  const Wide square = new_1 * new_1 + new_2 * new_2;
  const WideInt sliding = square > limit * limit;
  const Wide scale = sliding ? limit / sqrt(sliding ? square : splat(1)) : splat(1);
  new_1 *= scale, new_2 *= scale;
  v.push(c, c.tangent_1, c.slide_1_a, c.slide_1_b, new_1 - c.slide_impulse_1);
  v.push(c, c.tangent_2, c.slide_2_a, c.slide_2_b, new_2 - c.slide_impulse_2);
  c.slide_impulse_1 = new_1, c.slide_impulse_2 = new_2;
}

/// Friction against turning about the normal; its limit is that of the loaded points about their
/// middle.
void twist(ConstraintBlock& c, Motion& v) {
  Wide lever = c.point[0].impulse * c.point[0].arm;
  for (int i = 1; i < c.points; ++i) lever += c.point[i].impulse * c.point[i].arm;
  const Wide limit = c.friction * lever;
  const Wide u = dot(c.twist_b, v.b.angular) - dot(c.twist_a, v.a.angular);
  const Wide next = max(-limit, min(limit, c.twist_impulse - c.twist_mass * u));
  v.twist(c, next - c.twist_impulse);
  c.twist_impulse = next;
}

template <bool kBiased>
void press(ConstraintBlock& c, Motion& v, const Motion& x, const SoftStep& soft) {
  const Wide zero = splat(0), one = splat(1);
  const Softness& press = soft.press[c.points - 1];
  for (int i = 0; i < c.points; ++i) {
    PointLanes& p = c.point[i];
    const Wide s = p.separation + x.along(c.normal, p.turn_a, p.turn_b);
    const WideInt apart = s > zero;
    Wide u = v.along(c.normal, p.turn_a, p.turn_b);
    Wide change;
    if constexpr (kBiased) {
      u += apart ? s * soft.inverse_h : max(s * press.rate, splat(-soft.push_m_s));
      const Wide mass_scale = apart ? one : splat(press.mass_scale);
      const Wide impulse_scale = apart ? zero : splat(press.impulse_scale);
      change = -p.mass * mass_scale * u - impulse_scale * p.impulse;
    } else {
      u += apart ? s * soft.inverse_h : zero;
      change = -p.mass * u;
    }
    const Wide next = max(zero, p.impulse + change);
    v.push(c, c.normal, p.turn_a, p.turn_b, next - p.impulse);
    p.impulse = next;
  }
}

template <bool kBiased>
void sweep(ConstraintBlock& c, BodyRow* rows, const SoftStep& soft) {
  Motion v(c, rows, &BodyRow::velocity);
  const Motion x(c, rows, &BodyRow::position);
  slide<kBiased>(c, v, x, soft);
  if (c.points > 1) twist(c, v);
  press<kBiased>(c, v, x, soft);
  store_velocity(v.a, c.row_a, rows);
  store_velocity(v.b, c.row_b, rows);
}

void note_impacts(ConstraintBlock& c) {
  for (int i = 0; i < c.points; ++i)
    c.point[i].most_impulse = max(c.point[i].most_impulse, c.point[i].impulse);
}

}  // namespace

void warm_start(ConstraintBlock& c, BodyRow* rows) {
  Motion v(c, rows, &BodyRow::velocity);
  v.push(c, c.tangent_1, c.slide_1_a, c.slide_1_b, c.slide_impulse_1);
  v.push(c, c.tangent_2, c.slide_2_a, c.slide_2_b, c.slide_impulse_2);
  v.twist(c, c.twist_impulse);
  for (int i = 0; i < c.points; ++i)
    v.push(c, c.normal, c.point[i].turn_a, c.point[i].turn_b, c.point[i].impulse);
  store_velocity(v.a, c.row_a, rows);
  store_velocity(v.b, c.row_b, rows);
}

void sweep_biased(ConstraintBlock& c, BodyRow* rows, const SoftStep& soft) {
  sweep<true>(c, rows, soft);
  if (c.bouncy) note_impacts(c);
}

void sweep_relaxed(ConstraintBlock& c, BodyRow* rows, const SoftStep& soft) {
  sweep<false>(c, rows, soft);
  if (c.bouncy) note_impacts(c);
  if (!c.summed) return;
  c.total = c.total + c.normal * total_impulse(c) + c.tangent_1 * c.slide_impulse_1 +
            c.tangent_2 * c.slide_impulse_2;
}

void bounce(ConstraintBlock& c, BodyRow* rows) {
  Motion v(c, rows, &BodyRow::velocity);
  const Wide zero = splat(0);
  for (int i = 0; i < c.points; ++i) {
    const PointLanes& p = c.point[i];
    const Wide u = v.along(c.normal, p.turn_a, p.turn_b);
    const WideInt active = (p.rebound > zero) & (p.most_impulse > zero);
    const Wide change = active ? max(zero, p.mass * (p.rebound - u)) : zero;
    v.push(c, c.normal, p.turn_a, p.turn_b, change);
    c.total = c.total + c.normal * change;
  }
  store_velocity(v.a, c.row_a, rows);
  store_velocity(v.b, c.row_b, rows);
}

Wide speed_along(const ConstraintBlock& c, int point, const BodyRow* rows) {
  const Motion v(c, rows, &BodyRow::velocity);
  return v.along(c.normal, c.point[point].turn_a, c.point[point].turn_b);
}

Wide separation_now(const ConstraintBlock& c, int point, const BodyRow* rows) {
  const Motion x(c, rows, &BodyRow::position);
  return c.point[point].separation +
         x.along(c.normal, c.point[point].turn_a, c.point[point].turn_b);
}

}  // namespace sunder::solver
