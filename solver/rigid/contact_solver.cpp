// The stages of a solve and what each does to a body or a block.
#include "solver/rigid/contact_solver.h"

#include <algorithm>

#include "solver/rigid/motion.h"
#include "solver/rigid/sweep.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kBodyGrain = 128;
constexpr std::uint32_t kBlockGrain = 8;
// Contact frequency times substep, by the number of points less one: see docs/decisions/003. Two
// sweeps keep up with 0.25 where pieces touch in a point or two, as rubble does. Faces that meet in
// four are four springs side by side, and friction as stiff as they are makes a standing wave of a
// wall.
constexpr double kPressStiffness[4] = {0.25, 0.25, 0.2, 0.18};
constexpr double kSlideStiffness[4] = {0.25, 0.25, 0.125, 0.125};
constexpr double kDamping = 5;   // ratio to critical
constexpr double kPush_m_s = 4;  // fastest correction of an overlap
// Farthest turn of a touching body within a step: beyond, contacts that are straight lines for the
// step would feed its spin. Free flight has no such limit.
constexpr double kMostTurn = 0.785;
constexpr double kPi = 3.14159265358979323846;

enum StageKind {
  kFly,
  kBegin,
  kPrepare,
  kWarmStart,
  kFirstKick,
  kKick,
  kBiased,
  kMove,
  kRelaxed,
  kBounce,
  kStore,
  kFinish,
  kJointBegin,
  kJointWarmStart,
  kJointPush,
  kJointTurn,
  kJointRelax,
  kJointTest
};

Softness softness(double stiffness, double h) {
  const double omega_h = 2 * kPi * stiffness;
  const double a1 = 2 * kDamping + omega_h, a2 = omega_h * a1, a3 = 1 / (1 + a2);
  return {static_cast<float>(omega_h / h / a1), static_cast<float>(a2 * a3),
          static_cast<float>(a3)};
}

SoftStep soft_step(double h) {
  SoftStep step;
  for (int i = 0; i < 4; ++i) {
    step.press[i] = softness(kPressStiffness[i], h);
    step.slide[i] = softness(kSlideStiffness[i], h);
  }
  step.inverse_h = static_cast<float>(1 / h);
  step.push_m_s = static_cast<float>(kPush_m_s);
  return step;
}

void limit_spin(Vec3& angular_velocity, double dt_s) {
  const double turn = dt_s * angular_velocity.norm();
  if (turn > kMostTurn) angular_velocity *= kMostTurn / turn;
}

Vec3f linear(Wide v) { return {v[0], v[1], v[2]}; }
Vec3f angular(Wide v) { return {v[3], v[4], v[5]}; }

}  // namespace

ContactSolveReport ContactSolver::solve(double dt_s, int substeps, const Vec3& gravity_W,
                                        Bodies& bodies, Contacts& contacts, Joints& joints) {
  collect_blocks(bodies, contacts);
  joint_solver_.collect(bodies, joints, in_contact_);
  collect_bodies(bodies);
  const double h = dt_s / substeps;
  const SoftStep soft = soft_step(h);
  PrepareStep step;
  step.gravity_W = gravity_W.cast<float>();
  step.impulse_scale = last_h_s_ > 0 ? static_cast<float>(h / last_h_s_) : 1.f;
  step.bounce_speed_m_s = static_cast<float>(2 * gravity_W.norm() * dt_s) + 1e-3f;
  const Vec3f kick = (h * gravity_W).cast<float>();
  const Wide gravity = {kick.x(), kick.y(), kick.z(), 0, 0, 0, 0, 0};
  const auto h_f = static_cast<float>(h);
  const JointStep joint_step{h, double{step.impulse_scale}};
  BodyRow* rows = rows_.data();

  auto work = [&](int kind, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      switch (kind) {
        case kFly:
          fly(bodies, flying_[i], gravity_W, dt_s);
          break;
        case kBegin:
          begin_body(active_[i], dt_s, bodies);
          break;
        case kPrepare:
          prepare_block(contacts, bodies, root_W_, rows, step, blocks_[i]);
          break;
        case kWarmStart:
          warm_start(blocks_[i], rows);
          break;
        case kFirstKick: {
          BodyRow& row = rows[active_[i] + 1];
          row.velocity = row.base = row.velocity + gravity;
          break;
        }
        case kKick: {
          // All impulses of a substep, warm start included, act on `base`: what they did to the
          // velocity is the warm start of the next substep.
          BodyRow& row = rows[active_[i] + 1];
          const Wide impulses = row.velocity - row.base;
          row.base = row.velocity + gravity;
          row.velocity = row.base + impulses;
          break;
        }
        case kBiased:
          sweep_biased(blocks_[i], rows, soft);
          break;
        case kMove:
          rows[active_[i] + 1].position += h_f * rows[active_[i] + 1].velocity;
          break;
        case kRelaxed:
          sweep_relaxed(blocks_[i], rows, soft);
          break;
        case kBounce:
          if (blocks_[i].bouncy) bounce(blocks_[i], rows);
          break;
        case kStore:
          store_block(blocks_[i], rows, contacts);
          break;
        case kFinish:
          finish_body(active_[i], bodies);
          break;
        case kJointBegin:
          joint_solver_.begin(i, bodies, joints, root_W_, rows);
          break;
        case kJointWarmStart:
          joint_solver_.warm_start(i, joint_step, rows);
          break;
        case kJointPush:
          joint_solver_.push(i, joint_step, rows);
          break;
        case kJointTurn:
          joint_solver_.turn(i, rows);
          break;
        case kJointRelax:
          joint_solver_.relax(i, joint_step, rows);
          break;
        case kJointTest:
          joint_solver_.test(i, joint_step, rows);
          break;
      }
    }
  };
  run_stages(plan(substeps), work);
  last_h_s_ = h;
  ContactSolveReport solved = report();
  solved.outside_impulse_Ns += joint_solver_.finish(bodies, joints);
  return solved;
}

std::vector<Stage> ContactSolver::plan(int substeps) const {
  std::vector<Stage> stages;
  auto all_bodies = [&](int kind) {
    stages.push_back({kind, 0, static_cast<std::uint32_t>(active_.size()), kBodyGrain});
  };
  auto all_blocks = [&](int kind) {
    stages.push_back({kind, 0, static_cast<std::uint32_t>(blocks_.size()), kBlockGrain});
  };
  auto each_color = [&](int kind) {
    for (Stage color : colors_) {
      color.kind = kind;
      stages.push_back(color);
    }
  };
  stages.push_back({kFly, 0, static_cast<std::uint32_t>(flying_.size()), kBodyGrain});
  if (active_.empty()) return stages;
  all_bodies(kBegin);
  all_blocks(kPrepare);
  joint_solver_.each_color(kJointBegin, stages);
  for (int s = 0; s < substeps; ++s) {
    all_bodies(s == 0 ? kFirstKick : kKick);
    if (s == 0) joint_solver_.each_color(kJointWarmStart, stages);
    if (s == 0) each_color(kWarmStart);
    joint_solver_.each_color(kJointPush, stages);
    each_color(kBiased);
    all_bodies(kMove);
    joint_solver_.each_color(kJointTurn, stages);
    joint_solver_.each_color(kJointRelax, stages);
    each_color(kRelaxed);
    joint_solver_.each_color(kJointTest, stages);
  }
  each_color(kBounce);
  all_blocks(kStore);
  all_bodies(kFinish);
  return stages;
}

void ContactSolver::collect_blocks(const Bodies& bodies, const Contacts& contacts) {
  constexpr std::size_t kKeys = (kMaxColors + 1) * 4;
  std::uint32_t start[kKeys + 1] = {};
  in_contact_.assign(bodies.size(), 0);
  auto key = [](const Manifold& m) { return std::size_t{m.color} * 4 + 4 - m.count; };
  auto for_each = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < contacts.manifolds.size(); ++i) {
      const Manifold& m = contacts.manifolds[i];
      if (m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b))) visit(i, m);
    }
  };
  for_each([&](std::uint32_t, const Manifold& m) {
    ++start[key(m) + 1];
    in_contact_[m.body_a] = in_contact_[m.body_b] = 1;
  });
  for (std::size_t k = 0; k < kKeys; ++k) start[k + 1] += start[k];
  touching_.resize(start[kKeys]);
  std::uint32_t next[kKeys];
  std::copy(start, start + kKeys, next);
  for_each([&](std::uint32_t i, const Manifold& m) { touching_[next[key(m)]++] = i; });

  std::uint32_t used = 0;  // blocks of the last step are written over, not cleared
  colors_.clear();
  for (std::size_t color = 0; color <= kMaxColors; ++color) {
    const std::uint32_t begin = start[color * 4], end = start[color * 4 + 4];
    if (begin == end) continue;
    // Overflow: bodies may repeat, so one manifold a block, and one thread for all.
    const std::uint32_t width = color < kMaxColors ? kLanes : 1;
    const std::uint32_t first = used;
    for (std::uint32_t i = begin; i < end; i += width) {
      if (used == blocks_.size()) blocks_.emplace_back();
      ConstraintBlock& block = blocks_[used++];
      block.lanes = std::min(width, end - i);
      block.points = contacts.manifolds[touching_[i]].count;
      std::copy_n(touching_.begin() + i, block.lanes, block.manifold);
    }
    colors_.push_back({0, first, used - first, color < kMaxColors ? kBlockGrain : used - first});
  }
  blocks_.resize(used);
}

void ContactSolver::collect_bodies(const Bodies& bodies) {
  rows_.resize(bodies.size() + 1);
  rows_[0] = BodyRow{};
  root_W_.resize(bodies.size());
  active_.clear();
  flying_.clear();
  for (std::uint32_t body = 0; body < bodies.size(); ++body)
    if (bodies.awake(body)) (in_contact_[body] ? active_ : flying_).push_back(body);
}

void ContactSolver::begin_body(std::uint32_t body, double dt_s, Bodies& bodies) {
  bodies.angular_velocity[body] += gyroscopic_change(bodies, body, dt_s);
  limit_spin(bodies.angular_velocity[body], dt_s);
  root_W_[body] = bodies.rotation_f[body] * bodies.root_B[body];
  const Vec3 spin_B = bodies.rotation[body].conjugate() * bodies.angular_velocity[body];
  const Vec3f spin =
      bodies.root_B[body].transpose() * (bodies.inertia_B[body] * spin_B).cast<float>();
  const Vec3f v = bodies.velocity[body].cast<float>();
  BodyRow& row = rows_[body + 1];
  row.velocity = Wide{v.x(), v.y(), v.z(), spin.x(), spin.y(), spin.z(), 0, 0};
  row.start = row.base = row.velocity;
  row.position = Wide{};
}

void ContactSolver::finish_body(std::uint32_t body, Bodies& bodies) const {
  const BodyRow& row = rows_[body + 1];
  // Only the change goes back, so that the doubles keep what no contact touched.
  const Wide change = row.velocity - row.start;
  bodies.velocity[body] += linear(change).cast<double>();
  bodies.angular_velocity[body] += (root_W_[body] * angular(change)).cast<double>();
  const Vec3f way = linear(row.position);
  const Vec3f angle = root_W_[body] * angular(row.position);
  const Quat turn = turn_by(angle.cast<double>());
  // Energy is that of the velocity as an uneven body sees it, so it turns with the body.
  if (bodies.spins_freely[body])
    bodies.angular_velocity[body] = turn * bodies.angular_velocity[body];
  bodies.place(body, bodies.position[body] + way.cast<double>(), turn * bodies.rotation[body]);
  bodies.travelled_m[body] +=
      double{way.norm()} + 1.1 * double{angle.norm()} * bodies.reach_m[body];
}

ContactSolveReport ContactSolver::report() const {
  ContactSolveReport report;
  report.manifolds = static_cast<std::uint32_t>(touching_.size());
  for (const ConstraintBlock& c : blocks_) {
    for (std::uint32_t lane = 0; lane < c.lanes; ++lane) {
      report.outside_impulse_Ns +=
          double{c.outside_sign[lane]} * Hull::lane(c.total, lane).cast<double>();
      for (int i = 0; i < c.points; ++i)
        report.points += c.point[static_cast<std::size_t>(i)].mass[lane] > 0;
    }
  }
  return report;
}

}  // namespace sunder::solver
