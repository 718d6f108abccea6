// Gathers manifolds into lanes and stores the results in manifolds: the scalar part. The arithmetic
// on lanes is in derive_kernels.h.
#include "solver/rigid/contact/prepare.h"

#include <algorithm>
#include <cmath>

#include "solver/base/lanes.h"
#include "solver/rigid/collide/impacts.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

template <class V>
void set_columns(Triple<V> (&columns)[3], std::uint32_t lane, const Mat3f& root) {
  for (int k = 0; k < 3; ++k) set_lane(columns[k], lane, root.col(k));
}

Mat3f root_now(const Bodies& bodies, BodySlot body) {
  return bodies.rotation_f[body] * bodies.root_B[body];
}

template <std::uint32_t lanes>
void gather_bodies(const ContactStep& step, const Manifold& m, std::uint32_t lane,
                   ConstraintBlock<lanes>& c, GatheredBlock<lanes>& g) {
  const Bodies& bodies = step.bodies;
  const bool a = bodies.awake(m.body_a), b = bodies.awake(m.body_b);
  c.row_a[lane] = step.row(m.body_a);
  c.row_b[lane] = step.row(m.body_b);
  const bool moves_a = c.row_a[lane] != 0, moves_b = c.row_b[lane] != 0;
  c.inverse_mass_a[lane] = bodies.inverse_mass[m.body_a];
  c.inverse_mass_b[lane] = bodies.inverse_mass[m.body_b];
  // A sleeping body has its mass until derive() removes it: see sleep.h.
  const bool sleeps_a = !a && bodies.dynamic(m.body_a), sleeps_b = !b && bodies.dynamic(m.body_b);
  g.sleepers = g.sleepers || sleeps_a || sleeps_b;
  g.awake_a[lane] = moves_a ? 1 : 0, g.awake_b[lane] = moves_b ? 1 : 0;
  if (moves_a || sleeps_a)
    set_columns(g.root_a, lane, moves_a ? step.root_W[m.body_a] : root_now(bodies, m.body_a));
  if (moves_b || sleeps_b)
    set_columns(g.root_b, lane, moves_b ? step.root_W[m.body_b] : root_now(bodies, m.body_b));
  c.outside_sign[lane] = (a ? 0.f : 1.f) - (b ? 0.f : 1.f);
  set_lane(g.offset, lane,
           Vec3f((bodies.position[m.body_b] - bodies.position[m.body_a]).cast<float>()));
  g.share_a[lane] = m.normal_on_b ? 0 : 1;
  const Vec3 linear = bodies.velocity[m.body_b] - bodies.velocity[m.body_a];
  const Vec3 angular = bodies.angular_velocity[m.body_b] - bodies.angular_velocity[m.body_a];
  const double displacement_m =
      (linear.norm() + angular.norm() * double{m.size_m}) * step.context.dt_s;
  g.closes_gap[lane] =
      displacement_m > double{kArmMotion * m.size_m} ? 1 : 0;  // bodies at rest need no new arms
  set_lane(g.gravity, lane,
           ((b ? 1.f : 0.f) - (a ? 1.f : 0.f)) * step.context.gravity_W.cast<float>());
}

float push_m_s(const ContactStep& step, const Manifold& m) {
  return step.soft.push * std::sqrt(m.size_m);
}

/// Returns the maximum overlap that a contact corrects. The deep contacts of a body in a dense
/// cluster share the correction speed of two, however many shapes overlap there.
float most_overlap_m(const ContactStep& step, const Manifold& m) {
  if (step.deep_contacts.empty() || !m.deep) return 1e30f;
  const auto of = [&](BodySlot body) {
    return step.bodies.dynamic(body) ? step.deep_contacts[body] : 0;
  };
  const std::uint32_t many = std::max(of(m.body_a), of(m.body_b));
  if (many <= 2) return 1e30f;
  const float share = 2 / static_cast<float>(many);
  return share * push_m_s(step, m) / step.soft.of(m.count).normal.rate;
}

template <std::uint32_t lanes>
void gather_contact(const ContactStep& step, const Manifold& m, std::uint32_t lane,
                    ConstraintBlock<lanes>& c, GatheredBlock<lanes>& g) {
  set_lane(c.normal, lane, m.normal_W);
  set_lane(g.drift, lane, m.drift_W);
  set_lane(g.friction_impulse, lane, m.friction_impulse_W);
  set_lane(g.friction_arm_a, lane, m.friction_arm_A);
  set_lane(g.friction_arm_b, lane, m.friction_arm_B);
  if (m.count > 1) c.twist_impulse[lane] = m.twist_impulse;
  c.friction[lane] = m.friction;
  c.roll.arm[lane] = m.rolling_m;
  c.rolls = c.rolls || m.rolling_m > 0;
  set_lane(g.roll_impulse, lane, m.roll_impulse_W);
  c.rebound.restitution[lane] = m.restitution;
  c.bouncy = c.bouncy || m.restitution > 0;
  g.compliance_scale[lane] = m.compliance_scale;
  c.push_m_s[lane] = push_m_s(step, m);
  c.points = std::max<std::uint32_t>(c.points, m.count);
  c.face[lane] = m.count > 2 ? 1 : 0;
  const Softness& softness = step.soft.of(m.count).normal;
  g.normal_mass_scale[lane] = softness.mass_scale,
  g.normal_impulse_scale[lane] = softness.impulse_scale;
  const float most_overlap = most_overlap_m(step, m);
  for (std::size_t i = 0; i < m.count; ++i) {
    const ManifoldPoint& p = m.points[i];
    g.has[i][lane] = 1;
    set_lane(g.arm_a[i], lane, p.arm_A);
    set_lane(g.arm_b[i], lane, p.arm_B);
    c.point[i].separation[lane] = std::max(p.separation_m - p.rest_m, -most_overlap);
    c.point[i].impulse[lane] = p.impulse_Ns;
  }
}

}  // namespace

template <std::uint32_t lanes>
void prepare_block(const ContactStep& step, ConstraintBlock<lanes>& c, ArmLanes<lanes>* arms) {
  const std::uint32_t first = c.first, count = c.count;
  const bool split = c.split;
  c = ConstraintBlock<lanes>{};
  c.first = first, c.count = count, c.split = split;
  GatheredBlock<lanes> g;
  c.rebound.least_m_s = step.rebound_m_s;
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    g.parts_a[lane] = g.parts_b[lane] = g.normal_mass_scale[lane] = 1;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    const Manifold& m = step.contacts.manifolds[step.manifolds[first + lane]];
    gather_bodies(step, m, lane, c, g);
    gather_contact(step, m, lane, c, g);
    if (!split) continue;
    const SplitSides& sides = step.split[first + lane - step.first_split];
    c.parts.part_a[lane] = sides.part_a, c.parts.part_b[lane] = sides.part_b;
    g.parts_a[lane] = static_cast<float>(sides.parts_a);
    g.parts_b[lane] = static_cast<float>(sides.parts_b);
  }
  derive(g, c);
  if (!arms) return;
  *arms = {};
  for (int k = 0; k < 3; ++k) {
    arms->root_a[k] = g.root_a[k] * g.awake_a;
    arms->root_b[k] = g.root_b[k] * g.awake_b;
  }
  arms->share_a = g.share_a;
  arms->gap = g.gap, arms->closed_gap = g.closed_gap;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    const Manifold& m = step.contacts.manifolds[step.manifolds[first + lane]];
    const float square = m.size_m * m.size_m;
    arms->wide[lane] = m.is_ball_pair ? 0 : square;
    arms->near[lane] = kNegligible * kNegligible * square;
    arms->least[lane] = kArmMotion * kArmMotion * square;
  }
}

template <std::uint32_t lanes>
void prepare_impact(const ContactStep& step, const ConstraintBlock<lanes>& c,
                    ImpactLanes<lanes>& impact) {
  impact.least_m_s = WideOf<lanes>{};
  for (std::uint32_t lane = 0; lane < c.count; ++lane) {
    const Manifold& m = step.contacts.manifolds[step.manifolds[c.first + lane]];
    impact.least_m_s[lane] = static_cast<float>(least_impact_m_s(step.context, m));
  }
}

/// Returns the compliance for the load of a contact, approached from the compliance before.
template <std::uint32_t lanes>
float compliance_now(const ContactStep& step, const ConstraintBlock<lanes>& c, std::uint32_t lane,
                     const Manifold& m) {
  const float compliance_s = step.soft.of(m.count).normal.compliance_s,
              most_m = kStiffeningDepth * m.size_m;
  float compression_m = 0;
  for (std::uint32_t i = 0; i < c.points; ++i) {
    const float mass = c.point[i].mass[lane], rest_m = std::abs(m.points[i].rest_m);
    if (mass > 0)
      compression_m =
          std::max(compression_m, compliance_s * c.point[i].impulse[lane] / mass - rest_m);
  }
  const bool a_is_lighter = step.bodies.inverse_mass[m.body_a] > step.bodies.inverse_mass[m.body_b];
  const bool pinched = step.loaded_contacts[a_is_lighter ? m.body_a : m.body_b] >= kPinchedContacts;
  const float least =
      compression_m > most_m
          ? std::max(pinched ? kMinPinchedCompliance : kMinCompliance, most_m / compression_m)
          : 1;
  return std::clamp(least, kComplianceStep * m.compliance_scale,
                    std::min(1.f, m.compliance_scale / kComplianceStep));
}

/// Returns the weight of the last substep in the mean force of a contact; 1 for the first. The
/// larger body sets the time of the mean: a contact that the body lost as it began to fall must
/// still count when it would fall asleep.
float share_in_mean(const ContactStep& step, const Manifold& m) {
  if (m.mean_force_W.isZero(0)) return 1;
  const auto reach_m = [&](BodySlot body) {
    return step.bodies.dynamic(body) ? step.bodies.reach_m[body] : 0;
  };
  const double rest_s = step.context.rest_s(std::max(reach_m(m.body_a), reach_m(m.body_b)));
  return static_cast<float>(4 * step.context.dt_s / rest_s);
}

template <std::uint32_t lanes>
void store_block(const ContactStep& step, const ConstraintBlock<lanes>& c) {
  float separation[4][lanes];
  separations_now(c, step.rows, separation);
  for (std::uint32_t lane = 0; lane < c.count; ++lane) {
    Manifold& m = step.contacts.manifolds[step.manifolds[c.first + lane]];
    float normal = 0;
    for (std::size_t i = 0; i < m.count; ++i) {
      m.points[i].impulse_Ns = c.point[i].impulse[lane];
      m.points[i].separation_m = separation[i][lane] + m.points[i].rest_m;
      normal += m.points[i].impulse_Ns;
    }
    const float s1 = c.friction_impulse_1[lane], s2 = c.friction_impulse_2[lane];
    m.friction_impulse_W = s1 * lane_of(c.tangent_1, lane) + s2 * lane_of(c.tangent_2, lane);
    m.twist_impulse = c.twist_impulse[lane];
    if (c.rolls)
      m.roll_impulse_W = c.roll.impulse_1[lane] * lane_of(c.tangent_1, lane) +
                         c.roll.impulse_2[lane] * lane_of(c.tangent_2, lane);
    m.compliance_scale = compliance_now(step, c, lane, m);
    m.step_impulse_W = lane_of(c.total, lane);
    const Vec3f force_W = step.context.inverse_h * m.impulse_W();
    m.mean_force_W += share_in_mean(step, m) * (force_W - m.mean_force_W);
    const float limit = c.friction[lane] * 0.999f;
    if (s1 * s1 + s2 * s2 >= limit * limit * normal * normal) m.sticking = false;
  }
}

#define SUNDER_PREPARE(lanes)                                                                 \
  template void prepare_block(const ContactStep&, ConstraintBlock<lanes>&, ArmLanes<lanes>*); \
  template void prepare_impact(const ContactStep&, const ConstraintBlock<lanes>&,             \
                               ImpactLanes<lanes>&);                                          \
  template void store_block(const ContactStep&, const ConstraintBlock<lanes>&);
SUNDER_PREPARE(1)
SUNDER_PREPARE(4)
SUNDER_PREPARE(8)
SUNDER_PREPARE(16)
#undef SUNDER_PREPARE

}  // namespace sunder::solver
