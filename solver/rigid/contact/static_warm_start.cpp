// Read first: StaticWarmStart::apply(). The impulses are found by conjugate gradients over the
// sweeps of the solver: see nncg.h.
#include "solver/rigid/contact/static_warm_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/nncg.h"
#include "solver/base/lanes.h"
#include "solver/rigid/contact/kernels/sweep.h"
#include "solver/rigid/contact/load_path.h"
#include "solver/rigid/contact/prepare.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kGrain = 8;
constexpr int kLeastRounds = 4, kMostRounds = 4000;
constexpr double kMaxWork = 2e5;  // points times rounds at most, unless kLeastRounds are more
// of the squared impulses: bodies without support by then have none
constexpr double kNearlyConverged = 1e-7;
constexpr int kFirstCheck = 32;  // rounds before the first check of convergence; doubled after each
constexpr double kConverged = 1e-12;  // of the squared impulses, for the change of a round
constexpr float kNoRebound = 1e30f;   // m/s; no contact rebounds

BlockImpulses impulses_of(const StaticBlock& c) {
  BlockImpulses impulses;
  for (std::size_t i = 0; i < 4; ++i) impulses.normal[i] = c.point[i].impulse;
  impulses.friction_1 = c.friction_impulse_1, impulses.friction_2 = c.friction_impulse_2;
  impulses.twist = c.twist_impulse;
  return impulses;
}

void set_impulses(const BlockImpulses& impulses, StaticBlock& c) {
  for (std::size_t i = 0; i < 4; ++i) c.point[i].impulse = impulses.normal[i];
  c.friction_impulse_1 = impulses.friction_1, c.friction_impulse_2 = impulses.friction_2;
  c.twist_impulse = impulses.twist;
}

/// Returns a + s·b.
BlockImpulses sum(const BlockImpulses& a, float s, const BlockImpulses& b) {
  const Wide4 w = splat<Wide4>(s);
  BlockImpulses impulses;
  for (int i = 0; i < 4; ++i) impulses.normal[i] = a.normal[i] + w * b.normal[i];
  impulses.friction_1 = a.friction_1 + w * b.friction_1,
  impulses.friction_2 = a.friction_2 + w * b.friction_2;
  impulses.twist = a.twist + w * b.twist;
  return impulses;
}

/// Returns the square of the impulses; that of twist is divided by the arm of the first point.
double square_of(const StaticBlock& c, const BlockImpulses& a) {
  const Wide4 zero = {}, arm = c.point[0].arm;
  const Wide4 twist = arm > zero ? a.twist / (arm > zero ? arm : splat<Wide4>(1)) : zero;
  Wide4 square = a.friction_1 * a.friction_1 + a.friction_2 * a.friction_2 + twist * twist;
  for (int i = 0; i < 4; ++i) square += a.normal[i] * a.normal[i];
  double all = 0;
  for (std::uint32_t lane = 0; lane < kStaticLanes; ++lane) all += double{square[lane]};
  return all;
}

/// Returns the largest of three speeds at the middle of the contact: of the surfaces against each
/// other, and of each against the world. Bodies that move together, as pieces of a toppling slab,
/// are not at rest, whatever supports them.
double greatest_speed(const Manifold& m, const Bodies& bodies) {
  auto velocity = [&](BodySlot body, const Vec3f& arm) {
    return Vec3(bodies.velocity[body] + bodies.angular_velocity[body].cross(arm.cast<double>()));
  };
  const Vec3 a = velocity(m.body_a, m.friction_arm_A), b = velocity(m.body_b, m.friction_arm_B);
  return std::max({(b - a).norm(), a.norm(), b.norm()});
}

/// Closes gaps below kClosedGap, so that contacts have the same impulses for any substep.
void close_gaps(const ContactStep& step, StaticBlock& c) {
  for (std::uint32_t lane = 0; lane < c.count; ++lane) {
    const float none_m =
        kClosedGap * step.contacts.manifolds[step.manifolds[c.first + lane]].size_m;
    for (std::uint32_t i = 0; i < c.points; ++i) {
      const float separation_m = c.point[i].separation[lane];
      if (separation_m > 0 && separation_m < none_m) c.point[i].separation[lane] = 0;
    }
  }
}

/// Returns the compression of a point by its impulse.
float compression_m(const StaticBlock& c, std::uint32_t lane, std::size_t point,
                    float compliance_s) {
  const float mass = c.point[point].mass[lane];
  return mass > 0 ? compliance_s * c.point[point].impulse[lane] / mass : 0;
}

/// Stores the impulses of the points, and the separations at which they have them.
void store_points(const StaticBlock& c, std::uint32_t lane, float compliance_s, float factor,
                  Manifold& m) {
  float depth[4] = {}, deepest = 0;
  for (std::size_t i = 0; i < m.count; ++i) {
    m.points[i].impulse_Ns = factor * c.point[i].impulse[lane];
    depth[i] = factor * compression_m(c, lane, i, compliance_s);
    deepest = std::max(deepest, depth[i]);
  }
  // An overlap no larger than the compression by the load is at rest too.
  const float most = kMaxRestOffset * m.size_m, least = -std::min(deepest, most);
  for (std::size_t i = 0; i < m.count; ++i) {
    ManifoldPoint& p = m.points[i];
    p.rest_m = std::clamp(p.separation_m + depth[i], least, depth[i] > 0 ? most : 0);
  }
}

/// Stores the impulses of friction, and the drift of its anchors that they need.
void store_friction(const StaticBlock& c, std::uint32_t lane, float compliance_s, float factor,
                    Manifold& m) {
  const float s1 = factor * c.friction_impulse_1[lane], s2 = factor * c.friction_impulse_2[lane];
  const Vec3f t1 = lane_of(c.tangent_1, lane), t2 = lane_of(c.tangent_2, lane);
  m.friction_impulse_W = s1 * t1 + s2 * t2;
  m.twist_impulse = factor * c.twist_impulse[lane];
  const float m11 = c.friction_mass_11[lane], m12 = c.friction_mass_12[lane],
              m22 = c.friction_mass_22[lane];
  const float det = m11 * m22 - m12 * m12;
  if (!(det > 0)) return;
  const float drift_1 = (m22 * s1 - m12 * s2) / det, drift_2 = (m11 * s2 - m12 * s1) / det;
  Vec3f drift = -compliance_s * (drift_1 * t1 + drift_2 * t2);
  const float length = drift.norm(), most = kMaxRestOffset * m.size_m;
  if (length > most) drift *= most / length;
  m.drift_W += drift;
  m.friction_arm_B += drift;
}

}  // namespace

void StaticWarmStart::apply(const StepContext& context, double factor, const Bodies& bodies,
                            Contacts& contacts) {
  if (!collect(context, bodies, contacts) || !(factor > 0)) return;
  begin(context, bodies, contacts);
  estimate_impulses(context, bodies, contacts);
  const auto first_split = static_cast<std::uint32_t>(manifolds_.size());
  const ContactStep step{context, bodies,  contacts,       manifolds_,         first_split,
                         {},      root_W_, {rows_.data()}, soft_step(context), kNoRebound};
  const double gravity_dv_m_s = context.h_s * context.gravity_W.norm();
  find_impulses(step, gravity_dv_m_s);
  find_supported(gravity_dv_m_s, bodies);
  mark_overloaded(context.gravity_W, step.soft, bodies, contacts);
  store(step.soft, static_cast<float>(factor), bodies, contacts);
}

bool StaticWarmStart::collect(const StepContext& step, const Bodies& bodies, Contacts& contacts) {
  find_resting(step, bodies, contacts);
  make_blocks(contacts);
  return !manifolds_.empty();
}

/// Lists the manifolds that get a warm start, by colour and number of points.
void StaticWarmStart::find_resting(const StepContext& step, const Bodies& bodies,
                                   Contacts& contacts) {
  std::uint32_t start[kSweepKeys + 1] = {};
  std::vector<std::pair<std::uint32_t, ManifoldSlot>> resting;  // key, manifold
  resting.reserve(contacts.cold.size());
  const double slow_m_s = kRestingSpeed * step.fall_m_s;
  for (const ManifoldSlot i : std::exchange(contacts.cold, {})) {
    Manifold& m = contacts.manifolds[i];
    if (!m.cold) continue;  // removed, or listed twice
    m.cold = false;
    if (!touches_awake(m, bodies)) continue;
    const bool rests = std::abs(m.least_separation()) < kRestingDistance * m.size_m;
    if (!rests || greatest_speed(m, bodies) >= slow_m_s) continue;
    resting.emplace_back(m.sweep_key(), i);
    ++start[resting.back().first + 1];
  }
  for (std::size_t k = 0; k < kSweepKeys; ++k) start[k + 1] += start[k];
  manifolds_.resize(resting.size());
  for (const auto& [key, i] : resting) manifolds_[start[key]++] = i;
}

void StaticWarmStart::make_blocks(const Contacts& contacts) {
  blocks_.clear();
  blocks_.reserve(manifolds_.size() / kStaticLanes + kMaxColors);
  colors_.clear();
  for (std::uint32_t i = 0; i < manifolds_.size();) {
    const Manifold& m = contacts.manifolds[manifolds_[i]];
    // Manifolds without a colour may share bodies: one a block.
    const std::uint32_t width = m.color < kMaxColors ? kStaticLanes : 1;
    if (i == 0 || contacts.manifolds[manifolds_[i - 1]].color != m.color)
      colors_.push_back({static_cast<std::uint32_t>(blocks_.size()), 0, kGrain});
    StaticBlock& block = blocks_.emplace_back();
    block.first = i, block.points = m.count;
    for (; i < manifolds_.size() && block.count < width; ++i, ++block.count) {
      const Manifold& next = contacts.manifolds[manifolds_[i]];
      if (next.color != m.color || next.count != m.count) break;
    }
    ++colors_.back().count;
    if (width == 1) colors_.back().grain = colors_.back().count;
  }
}

void StaticWarmStart::begin(const StepContext& step, const Bodies& bodies,
                            const Contacts& contacts) {
  const Vec3f& gravity_dv = step.gravity_dv_W;
  rows_.resize(bodies.size() + 1);
  rows_[0] = BodyRow{};
  root_W_.resize(bodies.size());
  involved_.assign(bodies.size(), 0);
  involved_bodies_.clear();
  for (const ManifoldSlot i : manifolds_) {
    for (const BodySlot body : {contacts.manifolds[i].body_a, contacts.manifolds[i].body_b}) {
      if (involved_[body] || !bodies.awake(body)) continue;
      involved_[body] = 1;
      involved_bodies_.push_back(body);
      rows_[row_of(body)] = BodyRow{};
      rows_[row_of(body)].velocity =
          Wide{gravity_dv.x(), gravity_dv.y(), gravity_dv.z(), 0, 0, 0, 0, 0};
      root_W_[body] = bodies.rotation_f[body] * bodies.root_B[body];
    }
  }
  auto push = [&](BodySlot body, const Vec3f& impulse, const Vec3f& angular) {
    if (!involved_[body]) return;
    const Vec3f v = bodies.inverse_mass[body] * impulse, w = root_W_[body].transpose() * angular;
    rows_[row_of(body)].velocity += Wide{v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), 0, 0};
  };
  for (const Manifold& m : contacts.manifolds) {
    if (m.count == 0 || !(involved_[m.body_a] || involved_[m.body_b])) continue;
    auto apply = [&](const Vec3f& impulse, const Vec3f& arm_A, const Vec3f& arm_B) {
      push(m.body_a, -impulse, -arm_A.cross(impulse));
      push(m.body_b, impulse, arm_B.cross(impulse));
    };
    for (std::size_t i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[i];
      apply(p.impulse_Ns * m.normal_W, p.arm_A, p.arm_B);
    }
    apply(m.friction_impulse_W, m.friction_arm_A, m.friction_arm_B);
    const Vec3f angular = m.twist_impulse * m.normal_W;
    push(m.body_a, Vec3f::Zero(), -angular);
    push(m.body_b, Vec3f::Zero(), angular);
  }
}

/// Finds a first estimate, from which few rounds converge.
void StaticWarmStart::estimate_impulses(const StepContext& step, const Bodies& bodies,
                                        Contacts& contacts) {
  loads_.assign(bodies.size(), {});
  const Vec3f& gravity_dv = step.gravity_dv_W;
  for (const BodySlot body : bodies.slots()) {
    if (!involved_[body]) continue;
    const Wide& v = rows_[row_of(body)].velocity;
    const Vec3f velocity = linear(v), spin = angular(v);
    loads_[body].impulse_W = velocity / bodies.inverse_mass[body];
    loads_[body].angular_impulse_W = root_W_[body].transpose().inverse() * spin;
    loads_[body].supported = velocity.dot(gravity_dv) < 0.5f * gravity_dv.squaredNorm();
  }
  distribute_loads(step.gravity_W, manifolds_, bodies, loads_, contacts);
}

void StaticWarmStart::find_impulses(const ContactStep& step, double gravity_dv_m_s) {
  double points = 0;
  for (const StaticBlock& c : blocks_) points += c.points * static_cast<double>(c.count);
  const int rounds = std::clamp(static_cast<int>(kMaxWork / points), kLeastRounds, kMostRounds);
  change_.assign(blocks_.size(), {});
  direction_.assign(blocks_.size(), {});
  square_.resize(blocks_.size());
  Nncg nncg;
  float beta = 0;
  const auto run = [&](const auto& work) {  // runs on every block
    run_stages(colors_, [&](const StageItems&, std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) work(blocks_[i], i);
    });
  };
  const auto sweep = [&](StaticBlock& c, std::uint32_t i) {
    const BlockImpulses before = impulses_of(c);
    sweep_relaxed(c, step.rows, step.soft);
    change_[i] = sum(impulses_of(c), -1, before);
    square_[i] = {square_of(c, change_[i]), square_of(c, before)};
  };
  const auto step_along_direction = [&](StaticBlock& c, std::uint32_t i) {
    const BlockImpulses before = impulses_of(c);
    set_impulses(sum({}, beta, direction_[i]), c);
    warm_start(c, step.rows);
    set_impulses(sum(before, beta, direction_[i]), c);
    direction_[i] = sum(change_[i], beta, direction_[i]);
  };
  run([&](StaticBlock& c, std::uint32_t) { prepare_block(step, c), close_gaps(step, c); });
  run([&](StaticBlock& c, std::uint32_t) { warm_start(c, step.rows); });
  double last_seen = 0;
  std::size_t last_supported = 0;
  int next_check = kFirstCheck;
  for (int round = 0; round < rounds; ++round) {
    run(sweep);
    double square = 0, loads = 0;
    for (const auto& [of_change, of_loads] : square_) square += of_change, loads += of_loads;
    if (square <= kConverged * std::max(square, loads) || round + 1 == rounds) return;
    if (round == next_check) {
      // Rounding or sliding contacts may prevent convergence.
      const double seen = square / loads;
      const std::size_t supported = find_supported(gravity_dv_m_s, step.bodies);
      const bool stuck = seen > 0.5 * last_seen;
      const bool all = supported == involved_bodies_.size();
      if (seen < kNearlyConverged && supported <= last_supported && (stuck || !all)) return;
      last_seen = seen, last_supported = supported;
      next_check *= 2;
    }
    beta = static_cast<float>(nncg.beta(square));
    run(step_along_direction);
  }
}

/// Marks bodies as unsupported that would have more energy with these impulses than gravity gave
/// them: there were too few rounds, or nothing can support them. Returns the number of supported
/// bodies.
std::size_t StaticWarmStart::find_supported(double gravity_dv_m_s, const Bodies& bodies) {
  std::size_t supported = 0;
  for (const BodySlot body : involved_bodies_) {
    const Wide& v = rows_[row_of(body)].velocity;
    const Vec3f velocity = linear(v), spin = angular(v);  // of unit inertia
    const double energy =
        double{velocity.squaredNorm()} + double{bodies.inverse_mass[body] * spin.squaredNorm()};
    loads_[body].supported = energy <= kMaxResidualEnergy * gravity_dv_m_s * gravity_dv_m_s;
    supported += loads_[body].supported;
  }
  return supported;
}

/// Marks bodies as unsupported whose contacts would need a rest separation beyond the maximum, and
/// the bodies on them: they will fall, and contacts at rest are loaded springs, which would give
/// them energy.
void StaticWarmStart::mark_overloaded(const Vec3& gravity_W, const SoftStep& soft,
                                      const Bodies& bodies, const Contacts& contacts) {
  bool any = false;
  for (const StaticBlock& c : blocks_) {
    for (std::uint32_t lane = 0; lane < c.count; ++lane) {
      const Manifold& m = contacts.manifolds[manifolds_[c.first + lane]];
      float deepest = 0;
      for (std::size_t i = 0; i < m.count; ++i)
        deepest =
            std::max(deepest, compression_m(c, lane, i, soft.of(c.points).normal.compliance_s));
      if (deepest <= kMaxRestOffset * m.size_m) continue;
      any = true;
      for (const BodySlot body : {m.body_a, m.body_b}) loads_[body].supported = false;
    }
  }
  if (any) mark_unsupported_above(gravity_W, manifolds_, bodies, contacts, loads_);
}

void StaticWarmStart::store(const SoftStep& soft, float factor, const Bodies& bodies,
                            Contacts& contacts) const {
  for (const StaticBlock& c : blocks_) {
    for (std::uint32_t lane = 0; lane < c.count; ++lane) {
      Manifold& m = contacts.manifolds[manifolds_[c.first + lane]];
      auto supported = [&](BodySlot body) { return !involved_[body] || loads_[body].supported; };
      const float part = supported(m.body_a) && supported(m.body_b) ? factor : 0;
      store_points(c, lane, soft.of(c.points).normal.compliance_s, part, m);
      store_friction(c, lane, soft.of(c.points).friction.compliance_s, part, m);
      m.friction_anchor_B = bodies.rotation_f[m.body_b].transpose() * m.friction_arm_B;
    }
  }
}

}  // namespace sunder::solver
