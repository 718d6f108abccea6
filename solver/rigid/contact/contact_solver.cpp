// The stages of a solve and what each does to a body or a block.
#include "solver/rigid/contact/contact_solver.h"

#include <algorithm>

#include "engine/base/rotation.h"
#include "solver/rigid/body/motion.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kBodyGrain = 128;
constexpr std::uint32_t kManifoldGrain = 64;

enum StageKind {
  kFly,
  kBegin,
  kPrepare,
  kWarmStart,
  kFirstKick,
  kKick,
  kJoinAndKick,
  kBiased,
  kJoin,
  kJoinAndMove,
  kRelaxed,
  kLastRelaxed,
  kWeigh,
  kJudge,
  kScaleBody,
  kScaleImpulses,
  kBounce,
  kStore,
  kFinish,
  kMark,
  kMeasure,
  kFirstBeta,
  kBeta,
  kGoOn,
  kJointBegin,
  kJointWarmStart,
  kJointPush,
  kJointRefresh,
  kJointRelax,
  kJointTest,
  kJointScale
};

Vec3f linear(Wide v) { return {v[0], v[1], v[2]}; }
Vec3f angular(Wide v) { return {v[3], v[4], v[5]}; }

}  // namespace

ContactSolver::ContactSolver(const ContactSolverOptions& options)
    : options_(options), blocks_(make_contact_blocks(options.lanes)) {}

ContactSolveReport ContactSolver::solve(double dt_s, int substeps, const Vec3& gravity_W,
                                        Bodies& bodies, Contacts& contacts, Joints& joints) {
  collect_blocks(bodies, contacts);
  split_bodies(bodies, contacts);
  accelerated_ = options_.accelerated && options_.sweeps > 1 && split_.empty();
  if (accelerated_) blocks_->remember();
  energy_.resize(accelerated_ ? touching_.size() : 0);
  jointed_.assign(bodies.size(), 0);
  joint_solver_.collect(bodies, joints, jointed_);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) in_contact_[i] |= jointed_[i];
  collect_bodies(bodies);
  energy_guard_.collect(touching_, active_, joint_solver_.joined(), 4 * dt_s * gravity_W.norm(),
                        bodies, contacts);
  const double h = dt_s / substeps;
  BodyRow* rows = rows_.data();
  ContactStep step{bodies,
                   contacts,
                   touching_,
                   first_split_,
                   split_,
                   root_W_,
                   {rows, parts_.data()},
                   soft_step(h, FroudeScale(gravity_W))};
  step.deep_contacts = deep_contacts_;
  step.loaded_contacts = loaded_contacts_;
  step.gravity_W = gravity_W.cast<float>();
  step.impulse_scale = last_h_s_ > 0 ? static_cast<float>(h / last_h_s_) : 1.f;
  step.bounce_speed_m_s = static_cast<float>(2 * gravity_W.norm() * dt_s);
  const Vec3f kick = (h * gravity_W).cast<float>();
  const Wide gravity = {kick.x(), kick.y(), kick.z(), 0, 0, 0, 0, 0};
  const auto h_f = static_cast<float>(h);
  const JointStep joint_step{h, double{step.impulse_scale}, FroudeScale(gravity_W)};

  auto work_on_body = [&](int kind, std::uint32_t i) {
    const std::uint32_t body = (kind == kFly ? flying_ : active_)[i];
    BodyRow& row = rows[body + 1];
    switch (kind) {
      case kFly:
        return fly(bodies, body, gravity_W, dt_s);
      case kBegin:
        return begin_body(body, dt_s, bodies);
      case kFirstKick:
        row.velocity = row.base = row.velocity + gravity;
        return;
      case kJoinAndKick:
        join_parts(body);
        [[fallthrough]];
      case kKick: {
        // All impulses of a substep, warm start included, act on `base`: what they did to the
        // velocity is the warm start of the next substep.
        const Wide impulses = row.velocity - row.base;
        row.base = row.velocity + gravity;
        row.velocity = row.base + impulses;
        return;
      }
      case kJoin:
        return join_parts(body);
      case kWeigh:
        return energy_guard_.weigh(body, bodies.inverse_mass[body], row);
      case kScaleBody:
        if (energy_guard_.objects())
          row.velocity =
              row.base + energy_guard_.share_of_row()[body + 1] * (row.velocity - row.base);
        return;
      case kJoinAndMove:
        join_parts(body);
        row.position += h_f * row.velocity;
        return;
      case kFinish:
        return finish_body(body, bodies);
    }
  };
  auto work_on_joints = [&](int kind, std::uint32_t i) {
    switch (kind) {
      case kJointBegin:
        return joint_solver_.begin(i, bodies, joints, root_W_, rows);
      case kJointWarmStart:
        return joint_solver_.warm_start(i, joint_step, rows);
      case kJointPush:
        return joint_solver_.push(i, joint_step, rows);
      case kJointRefresh:
        return joint_solver_.refresh(i, rows);
      case kJointRelax:
        return joint_solver_.relax(i, joint_step, rows);
      case kJointTest:
        return joint_solver_.test(i, joint_step, rows);
      case kJointScale:
        if (energy_guard_.objects())
          joint_solver_.scale_impulses(i, joint_step, energy_guard_.share_of_row(), rows);
        return;
    }
  };
  auto work = [&](int kind, std::uint32_t begin, std::uint32_t end) {
    switch (kind) {
      case kPrepare:
        return blocks_->prepare(begin, end, step);
      case kWarmStart:
        return blocks_->warm_start(begin, end, step);
      case kBiased:
        return blocks_->sweep_biased(begin, end, step);
      case kRelaxed:
        return blocks_->sweep_relaxed(begin, end, step);
      case kLastRelaxed:
        blocks_->sweep_relaxed(begin, end, step);
        return blocks_->sum_impulses(begin, end);
      case kJudge:
        return energy_guard_.judge(active_);
      case kScaleImpulses:
        if (energy_guard_.objects())
          blocks_->scale_impulses(begin, end, energy_guard_.share_of_row());
        return;
      case kBounce:
        return blocks_->bounce(begin, end, step);
      case kStore:
        return blocks_->store(begin, end, step);
      case kMark:
        return blocks_->mark(begin, end);
      case kMeasure:
        return blocks_->measure(begin, end, energy_.data());
      case kFirstBeta:
      case kBeta:
        return choose_beta(kind == kFirstBeta);
      case kGoOn:
        return blocks_->go_on(begin, end, step, beta_);
    }
    for (std::uint32_t i = begin; i < end; ++i)
      kind >= kJointBegin ? work_on_joints(kind, i) : work_on_body(kind, i);
  };
  run_stages(plan(substeps), work);
  last_h_s_ = h;
  const Vec3 from_joints_Ns = joint_solver_.finish(bodies, joints);
  return {blocks_->outside_impulse_Ns() + from_joints_Ns,
          static_cast<std::uint32_t>(touching_.size()), points_};
}

std::vector<Stage> ContactSolver::plan(int substeps) const {
  std::vector<Stage> stages;
  auto all_bodies = [&](int kind) {
    stages.push_back({kind, 0, static_cast<std::uint32_t>(active_.size()), kBodyGrain});
  };
  auto all_blocks = [&](int kind) {
    stages.push_back({kind, 0, blocks_->size(), kManifoldGrain / blocks_->lanes()});
  };
  auto each_color = [&](int kind) {
    for (Stage color : colors_) {
      color.kind = kind;
      stages.push_back(color);
    }
  };
  auto join = [&] {
    if (!split_.empty()) all_bodies(kJoin);
  };
  // What follows the last sweep sees it joined: the move and the kick do that themselves, so that
  // mass splitting waits once a sweep.
  auto sweep = [&](int joint_kind, int kind, int last_kind) {
    for (int i = 1; i <= options_.sweeps; ++i) {
      const bool last = i == options_.sweeps;
      if (accelerated_ && !last) all_blocks(kMark);
      joint_solver_.each_color(joint_kind, stages);
      each_color(last ? last_kind : kind);
      if (last) break;
      join();
      if (!accelerated_) continue;
      all_blocks(kMeasure);
      stages.push_back({i == 1 ? kFirstBeta : kBeta, 0, 1, 1});
      each_color(kGoOn);
    }
  };
  stages.push_back({kFly, 0, static_cast<std::uint32_t>(flying_.size()), kBodyGrain});
  if (active_.empty()) return stages;
  const bool joints = !joint_solver_.empty(), guarded = energy_guard_.watches();
  all_bodies(kBegin);
  all_blocks(kPrepare);
  joint_solver_.each_color(kJointBegin, stages);
  for (int s = 0; s < substeps; ++s) {
    all_bodies(s == 0 ? kFirstKick : joints || guarded ? kKick : kJoinAndKick);
    if (s == 0) joint_solver_.each_color(kJointWarmStart, stages);
    if (s == 0) each_color(kWarmStart), join();
    sweep(kJointPush, kBiased, kBiased);
    all_bodies(kJoinAndMove);
    joint_solver_.each_color(kJointRefresh, stages);
    sweep(kJointRelax, kRelaxed, kLastRelaxed);
    if (joints || guarded || s + 1 == substeps) join();
    joint_solver_.each_color(kJointTest, stages);
    if (!guarded) continue;
    all_bodies(kWeigh);
    stages.push_back({kJudge, 0, 1, 1});
    all_bodies(kScaleBody);
    all_blocks(kScaleImpulses);
    joint_solver_.each_color(kJointScale, stages);
  }
  each_color(kBounce);
  join();
  all_blocks(kStore);
  all_bodies(kFinish);
  return stages;
}

/// How far to go on along the way so far, by the energy of the changes.
void ContactSolver::choose_beta(bool first) {
  double energy = 0;
  for (const float of_manifold : energy_) energy += double{of_manifold};
  if (first) nncg_ = {};
  beta_ = static_cast<float>(nncg_.beta(energy));
}

void ContactSolver::collect_blocks(const Bodies& bodies, const Contacts& contacts) {
  std::uint32_t start[kSweepKeys + 1] = {};
  in_contact_.assign(bodies.size(), 0);
  loaded_contacts_.assign(bodies.size(), 0);
  points_ = 0;
  deep_contacts_.clear();
  auto for_each = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < contacts.manifolds.size(); ++i) {
      const Manifold& m = contacts.manifolds[i];
      if (m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b))) visit(i, m);
    }
  };
  for_each([&](std::uint32_t, const Manifold& m) {
    ++start[m.sweep_key() + 1];
    in_contact_[m.body_a] = in_contact_[m.body_b] = 1;
    if (m.normal_impulse() > 0)
      for (const std::uint32_t body : {m.body_a, m.body_b})
        loaded_contacts_[body] = std::min<std::uint8_t>(loaded_contacts_[body] + 1, kPinched);
    points_ += m.count;
    if (!m.deep) return;
    deep_contacts_.resize(bodies.size());
    ++deep_contacts_[m.body_a], ++deep_contacts_[m.body_b];
  });
  for (std::size_t k = 0; k < kSweepKeys; ++k) start[k + 1] += start[k];
  touching_.resize(start[kSweepKeys]);
  std::uint32_t next[kSweepKeys];
  std::copy(start, start + kSweepKeys, next);
  for_each([&](std::uint32_t i, const Manifold& m) { touching_[next[m.sweep_key()]++] = i; });

  blocks_->clear(touching_.size());
  colors_.clear();
  const std::uint32_t grain = kManifoldGrain / blocks_->lanes();
  for (std::uint32_t color = 0; color <= kMaxColors; ++color) {
    const std::uint32_t first = blocks_->size();
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t begin = start[color * 4 + k], end = start[color * 4 + k + 1];
      blocks_->add(begin, end - begin, 4 - k, color == kMaxColors);
    }
    const std::uint32_t count = blocks_->size() - first;
    if (count > 0) colors_.push_back({0, first, count, grain});
  }
  first_split_ = start[std::size_t{kMaxColors} * 4];
}

/// Cuts awake bodies into as many parts as they have split manifolds, in the order of these.
void ContactSolver::split_bodies(const Bodies& bodies, const Contacts& contacts) {
  const auto split = std::span(touching_).subspan(first_split_);
  split_.assign(split.size(), {});
  if (split.empty()) return;
  part_count_.assign(bodies.size(), 0);
  part_end_.assign(bodies.size(), 0);
  auto for_each_body = [&](const auto& visit) {
    for (std::size_t i = 0; i < split.size(); ++i) {
      const Manifold& m = contacts.manifolds[split[i]];
      if (bodies.awake(m.body_a)) visit(m.body_a, split_[i].part_a, split_[i].parts_a);
      if (bodies.awake(m.body_b)) visit(m.body_b, split_[i].part_b, split_[i].parts_b);
    }
  };
  for_each_body([&](std::uint32_t body, auto&, auto&) { ++part_count_[body]; });
  std::uint32_t all = 0;
  for (std::uint32_t body = 0; body < bodies.size(); ++body) {
    part_end_[body] = all;
    all += part_count_[body];
  }
  for_each_body([&](std::uint32_t body, std::uint32_t& part, std::uint32_t& parts) {
    part = part_end_[body]++;
    parts = part_count_[body];
  });
  parts_.resize(all);
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

void ContactSolver::join_parts(std::uint32_t body) {
  if (split_.empty() || part_count_[body] == 0) return;
  const std::uint32_t end = part_end_[body];
  Wide sum = parts_[end - part_count_[body]];
  for (std::uint32_t i = end - part_count_[body] + 1; i < end; ++i) sum += parts_[i];
  rows_[body + 1].velocity += sum;
}

void ContactSolver::finish_body(std::uint32_t body, Bodies& bodies) const {
  const BodyRow& row = rows_[body + 1];
  // Only the change goes back, so that the doubles keep what no contact touched.
  const Wide change = row.velocity - row.start;
  bodies.velocity[body] += linear(change).cast<double>();
  bodies.angular_velocity[body] += (root_W_[body] * angular(change)).cast<double>();
  const Vec3f way = linear(row.position);
  const Vec3f angle = root_W_[body] * angular(row.position);
  const Quat rotation = rotation_by(angle.cast<double>());
  // Energy is that of the velocity as an uneven body sees it, so it turns with the body.
  if (bodies.spins_freely[body])
    bodies.angular_velocity[body] = rotation * bodies.angular_velocity[body];
  bodies.place(body, bodies.position[body] + way.cast<double>(), rotation * bodies.rotation[body]);
  bodies.turned_m[body] += 1.1 * double{angle.norm()} * bodies.reach_m[body];
}

}  // namespace sunder::solver
