// Gathers manifolds into lanes, then works out Jacobians and masses eight at a time.
#include "solver/rigid/prepare.h"

#include "solver/rigid/sweep.h"

namespace sunder::solver {
namespace {

void set_lane(Wide3& v, std::uint32_t lane, const Vec3f& value) {
  v.x[lane] = value.x();
  v.y[lane] = value.y();
  v.z[lane] = value.z();
}

/// Columns of a root, in lanes.
struct RootLanes {
  Wide3 column[3] = {};

  void set(std::uint32_t lane, const Mat3f& root) {
    for (int k = 0; k < 3; ++k) set_lane(column[k], lane, root.col(k));
  }
  Wide3 to_root(const Wide3& angular) const {
    return {dot(column[0], angular), dot(column[1], angular), dot(column[2], angular)};
  }
};

struct Gathered {
  RootLanes root_a, root_b;
  Wide3 drift = {}, slide_impulse = {}, friction_arm_a = {}, friction_arm_b = {};
  Wide3 arm_a[4] = {}, arm_b[4] = {};
  Wide restitution = {};
  Wide3 gravity = {};  ///< Acceleration of b from a.
  Wide exists[4] = {};
  Wide awake_a = {}, awake_b = {};
  bool sleepers = false;
};

Mat3f root_now(const Bodies& bodies, std::uint32_t body) {
  return bodies.rotation_f[body] * bodies.root_B[body];
}

void gather(const Contacts& contacts, const Bodies& bodies, std::span<const Mat3f> root_W,
            const PrepareStep& step, ConstraintBlock& c, Gathered& g) {
  for (std::uint32_t lane = 0; lane < c.lanes; ++lane) {
    const Manifold& m = contacts.manifolds[c.manifold[lane]];
    const bool a = bodies.awake(m.body_a), b = bodies.awake(m.body_b);
    c.row_a[lane] = a ? static_cast<std::int32_t>(m.body_a + 1) : 0;
    c.row_b[lane] = b ? static_cast<std::int32_t>(m.body_b + 1) : 0;
    c.inverse_mass_a[lane] = bodies.inverse_mass[m.body_a];
    c.inverse_mass_b[lane] = bodies.inverse_mass[m.body_b];
    // A sleeper has its mass until prepare_block() takes it out: see sleep.h.
    const bool sleeps_a = !a && bodies.dynamic(m.body_a), sleeps_b = !b && bodies.dynamic(m.body_b);
    g.sleepers = g.sleepers || sleeps_a || sleeps_b;
    g.awake_a[lane] = a ? 1 : 0, g.awake_b[lane] = b ? 1 : 0;
    if (a || sleeps_a) g.root_a.set(lane, a ? root_W[m.body_a] : root_now(bodies, m.body_a));
    if (b || sleeps_b) g.root_b.set(lane, b ? root_W[m.body_b] : root_now(bodies, m.body_b));
    c.summed = c.summed || !a || !b || bodies.bears_load[m.body_a] || bodies.bears_load[m.body_b];
    c.outside_sign[lane] = (a ? 0.f : 1.f) - (b ? 0.f : 1.f);
    set_lane(g.gravity, lane, ((b ? 1.f : 0.f) - (a ? 1.f : 0.f)) * step.gravity_W);
    set_lane(c.normal, lane, m.normal_W);
    set_lane(g.drift, lane, m.drift_W);
    set_lane(g.slide_impulse, lane, step.impulse_scale * m.friction_impulse_W);
    set_lane(g.friction_arm_a, lane, m.friction_arm_A);
    set_lane(g.friction_arm_b, lane, m.friction_arm_B);
    c.twist_impulse[lane] = step.impulse_scale * m.twist_impulse;
    c.friction[lane] = m.friction;
    g.restitution[lane] = m.restitution;
    for (int i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
      set_lane(g.arm_a[i], lane, p.arm_A);
      set_lane(g.arm_b[i], lane, p.arm_B);
      c.point[static_cast<std::size_t>(i)].separation[lane] = p.separation_m;
      c.point[static_cast<std::size_t>(i)].impulse[lane] = step.impulse_scale * p.impulse_Ns;
      g.exists[i][lane] = 1;
    }
  }
}

Wide reciprocal(Wide x) {
  return x > splat(0) ? splat(1) / (x > splat(0) ? x : splat(1)) : splat(0);
}

void set_tangents(ConstraintBlock& c) {
  const Wide zero = splat(0), one = splat(1);
  const WideInt flat = c.normal.x * c.normal.x < splat(0.5f);
  const Wide3 helper = {flat ? one : zero, flat ? zero : one, zero};
  const Wide3 t = cross(c.normal, helper);
  const Wide square = dot(t, t);
  c.tangent_1 = t * (one / sqrt(square > zero ? square : one));
  c.tangent_2 = cross(c.normal, c.tangent_1);
}

void prepare_friction(const Gathered& g, Wide inverse_mass, ConstraintBlock& c) {
  auto to_root = [](const RootLanes& root, const Wide3& arm, const Wide3& direction) {
    return root.to_root(cross(arm, direction));
  };
  c.slide_1_a = to_root(g.root_a, g.friction_arm_a, c.tangent_1);
  c.slide_1_b = to_root(g.root_b, g.friction_arm_b, c.tangent_1);
  c.slide_2_a = to_root(g.root_a, g.friction_arm_a, c.tangent_2);
  c.slide_2_b = to_root(g.root_b, g.friction_arm_b, c.tangent_2);
  const Wide k11 = inverse_mass + dot(c.slide_1_a, c.slide_1_a) + dot(c.slide_1_b, c.slide_1_b);
  const Wide k22 = inverse_mass + dot(c.slide_2_a, c.slide_2_a) + dot(c.slide_2_b, c.slide_2_b);
  const Wide k12 = dot(c.slide_1_a, c.slide_2_a) + dot(c.slide_1_b, c.slide_2_b);
  const Wide scale = reciprocal(k11 * k22 - k12 * k12);
  c.slide_11 = k22 * scale, c.slide_12 = -k12 * scale, c.slide_22 = k11 * scale;
  c.twist_a = g.root_a.to_root(c.normal);
  c.twist_b = g.root_b.to_root(c.normal);
  c.twist_mass = reciprocal(dot(c.twist_a, c.twist_a) + dot(c.twist_b, c.twist_b));
  c.drift_1 = dot(g.drift, c.tangent_1), c.drift_2 = dot(g.drift, c.tangent_2);
  c.slide_impulse_1 = dot(g.slide_impulse, c.tangent_1);
  c.slide_impulse_2 = dot(g.slide_impulse, c.tangent_2);
}

/// Sleepers stay where they are: no response to any impulse.
void hold_sleepers(const Gathered& g, ConstraintBlock& c) {
  c.inverse_mass_a *= g.awake_a, c.inverse_mass_b *= g.awake_b;
  auto hold = [&](Wide3& a, Wide3& b) { a = a * g.awake_a, b = b * g.awake_b; };
  hold(c.slide_1_a, c.slide_1_b);
  hold(c.slide_2_a, c.slide_2_b);
  hold(c.twist_a, c.twist_b);
  for (int i = 0; i < c.points; ++i) {
    PointLanes& p = c.point[static_cast<std::size_t>(i)];
    hold(p.turn_a, p.turn_b);
  }
}

/// The speed at which the point will have closed its gap, by energy, times restitution.
Wide rebound_of(const Gathered& g, const ConstraintBlock& c, const PointLanes& p, Wide u,
                const PrepareStep& step) {
  const Wide zero = splat(0);
  const Wide fall = max(zero, -dot(c.normal, g.gravity)) * max(zero, p.separation);
  const Wide speed = sqrt(u * u + fall + fall);
  const WideInt bounces =
      (u < splat(-step.bounce_speed_m_s)) & (g.restitution > zero) & (p.mass > zero);
  return bounces ? speed * g.restitution : zero;
}

}  // namespace

void prepare_block(const Contacts& contacts, const Bodies& bodies, std::span<const Mat3f> root_W,
                   const BodyRow* rows, const PrepareStep& step, ConstraintBlock& c) {
  const std::uint32_t lanes = c.lanes;
  const int points = c.points;
  std::uint32_t manifold[kLanes];
  std::copy(c.manifold, c.manifold + kLanes, manifold);
  c = ConstraintBlock{};
  c.lanes = lanes, c.points = points;
  std::copy(manifold, manifold + kLanes, c.manifold);
  Gathered g;
  gather(contacts, bodies, root_W, step, c, g);
  set_tangents(c);
  const Wide inverse_mass = c.inverse_mass_a + c.inverse_mass_b;
  prepare_friction(g, inverse_mass, c);
  const bool bounces = bits(g.restitution > splat(0)) != 0;
  for (int i = 0; i < points; ++i) {
    PointLanes& p = c.point[static_cast<std::size_t>(i)];
    p.turn_a = g.root_a.to_root(cross(g.arm_a[i], c.normal));
    p.turn_b = g.root_b.to_root(cross(g.arm_b[i], c.normal));
    p.mass =
        g.exists[i] * reciprocal(inverse_mass + dot(p.turn_a, p.turn_a) + dot(p.turn_b, p.turn_b));
    const Wide3 off = g.arm_b[i] - g.friction_arm_b;
    const Wide3 lever = off - c.normal * dot(off, c.normal);
    p.arm = g.exists[i] * sqrt(dot(lever, lever));
    if (!bounces) continue;
    p.rebound = rebound_of(g, c, p, speed_along(c, i, rows), step);
    c.bouncy = c.bouncy || bits(p.rebound > splat(0)) != 0;
  }
  if (g.sleepers) hold_sleepers(g, c);
}

void store_block(const ConstraintBlock& c, const BodyRow* rows, Contacts& contacts) {
  const Wide limit = c.friction * splat(0.999f);
  for (std::uint32_t lane = 0; lane < c.lanes; ++lane) {
    Manifold& m = contacts.manifolds[c.manifold[lane]];
    float normal = 0;
    for (std::size_t i = 0; i < m.count; ++i) {
      m.points[i].impulse_Ns = c.point[i].impulse[lane];
      normal += m.points[i].impulse_Ns;
    }
    const float s1 = c.slide_impulse_1[lane], s2 = c.slide_impulse_2[lane];
    m.friction_impulse_W = s1 * Hull::lane(c.tangent_1, lane) + s2 * Hull::lane(c.tangent_2, lane);
    m.twist_impulse = c.twist_impulse[lane];
    m.step_impulse_W = Hull::lane(c.total, lane);
    if (s1 * s1 + s2 * s2 >= limit[lane] * limit[lane] * normal * normal) m.sticking = false;
  }
  for (int i = 0; i < c.points; ++i) {
    const Wide separation = separation_now(c, i, rows);
    for (std::uint32_t lane = 0; lane < c.lanes; ++lane) {
      Manifold& m = contacts.manifolds[c.manifold[lane]];
      if (i < m.count) m.points[static_cast<std::size_t>(i)].separation_m = separation[lane];
    }
  }
}

}  // namespace sunder::solver
