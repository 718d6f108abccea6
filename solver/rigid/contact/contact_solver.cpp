// Read first: ContactSolver::Stages::plan(), the list of the stages of a solve.
#include "solver/rigid/contact/contact_solver.h"

#include <algorithm>
#include <atomic>
#include <functional>

#include "engine/base/nncg.h"
#include "solver/rigid/body/motion.h"
#include "solver/rigid/body/row_exchange.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr std::uint32_t kBodyGrain = 128;
constexpr std::uint32_t kManifoldGrain = 64;
/// Number of restitution rounds in a substep: of balls in a row that propagate an impact.
constexpr int kRestitutionRounds = 16;

}  // namespace

/// The stages of one solve and their work on bodies, on blocks of manifolds and on groups of
/// joints.
class ContactSolver::Stages {
 public:
  Stages(ContactSolver& solver, const StepContext& step, Bodies& bodies, Contacts& contacts,
         Joints& joints)
      : solver_(solver),
        blocks_(*solver.blocks_),
        guard_(solver.energy_guard_),
        step_(step),
        bodies_(bodies),
        joints_(joints),
        rows_(solver.rows_.data() + solver.kinematic_.size()),
        accelerated_(!solver.energy_.empty()),
        guarded_(guard_.is_active()),
        gravity_{
            step.gravity_dv_W.x(), step.gravity_dv_W.y(), step.gravity_dv_W.z(), 0, 0, 0, 0, 0},
        half_fall_(static_cast<float>(0.5 * step.h_s) * gravity_),
        contact_step_{step,
                      bodies,
                      contacts,
                      solver.order_.manifolds(),
                      solver.order_.first_split(),
                      solver.splitting_.sides(),
                      solver.root_W_,
                      {rows_, solver.splitting_.parts(), solver.spins_.pending()},
                      soft_step(step),
                      static_cast<float>(kReboundSpeed * step.fall_m_s / step.substeps),
                      solver.order_.deep_contacts(),
                      solver.order_.loaded_contacts(),
                      solver.kinematic_rows_} {}

  void run() {
    plan();
    run_stages(stages_, [](const Stage& stage, std::uint32_t begin, std::uint32_t end) {
      stage.work(begin, end);
    });
  }

 private:
  struct Stage : StageItems {
    std::function<void(std::uint32_t begin, std::uint32_t end)> work;
  };

  void plan();
  template <auto solve_joints, auto sweep>
  void plan_sweeps(bool sum_impulses);
  void plan_restitution();
  void plan_energy_guard();

  // Each function appends the stages that do `work` on all items of a kind.
  template <class Work>
  void once(const Work& work) {
    stages_.push_back({{0, 1, 1}, [work](std::uint32_t, std::uint32_t) { work(); }});
  }
  template <auto work>
  void each_body() {
    const auto count = static_cast<std::uint32_t>(solver_.active_.size());
    stages_.push_back({{0, count, kBodyGrain}, [this](std::uint32_t begin, std::uint32_t end) {
                         for (std::uint32_t i = begin; i < end; ++i)
                           (this->*work)(solver_.active_[i]);
                       }});
  }
  template <class Work>
  void each_block(const Work& work) {
    stages_.push_back({{0, blocks_.size(), kManifoldGrain / blocks_.lanes()}, work});
  }
  template <auto work>
  void each_block() {
    each_block([this](auto begin, auto end) { (blocks_.*work)(begin, end, contact_step_); });
  }
  template <class Work>
  void each_color(const Work& work) {
    for (const StageItems& color : solver_.colors_) stages_.push_back({color, work});
  }
  template <auto work>
  void each_color() {
    each_color([this](auto begin, auto end) { (blocks_.*work)(begin, end, contact_step_); });
  }
  template <class Work>
  void each_joint_group(const Work& work) {
    for (const StageItems& color : solver_.joint_solver_.colors())
      stages_.push_back({color, [work](std::uint32_t begin, std::uint32_t end) {
                           for (std::uint32_t i = begin; i < end; ++i) work(i);
                         }});
  }
  template <auto work>
  void each_joint_group() {
    each_joint_group([this](auto i) { (solver_.joint_solver_.*work)(i, step_, rows_); });
  }
  void join_if_split() {
    if (!solver_.splitting_.empty()) each_body<&Stages::join>();
  }

  BodyRow& row(BodySlot body) { return rows_[row_of(body)]; }
  void load_body(BodySlot body) { load_row(bodies_, body, row(body), solver_.root_W_[body]); }
  void store_body(BodySlot body) {
    store_velocity_of_row(row(body), solver_.root_W_[body], body, bodies_);
  }
  void begin(BodySlot body);
  void add_first_gravity(BodySlot body) {
    BodyRow& r = row(body);
    r.velocity = r.base = r.velocity + gravity_;
    if (guarded_) guard_.record_energy_before(body, bodies_.inverse_mass[body], r);
  }
  /// Adds gravity to `base` before all impulses of a substep, warm start included: the change of
  /// velocity by the impulses is the warm start of the next substep.
  void add_gravity(BodySlot body) {
    BodyRow& r = row(body);
    const Wide impulses = r.velocity - r.base;
    r.base = r.velocity + gravity_;
    // The joint solver warm starts bodies that only joints hold: rounding of a difference would
    // accumulate.
    r.velocity = solver_.joint_solver_.hangs_free(body) ? r.base : r.base + impulses;
    if (guarded_) guard_.record_energy_before(body, bodies_.inverse_mass[body], r);
  }
  void join_and_add_gravity(BodySlot body) { join(body), add_gravity(body); }
  void join(BodySlot body) { solver_.splitting_.join(body, row(body)); }
  void join_and_move(BodySlot body) {
    join(body);
    BodyRow& r = row(body);
    const Wide pushed = r.velocity - r.base;
    const bool flies = linear(pushed).isZero(0) && angular(pushed).isZero(0);
    if (flies || (guarded_ && guard_.is_in_free_fall(body))) r.position -= half_fall_;
    r.position += static_cast<float>(step_.h_s) * r.velocity;
  }
  void record_impulse_work(BodySlot body) {
    guard_.record_impulse_work(body, bodies_.inverse_mass[body], row(body));
  }
  void scale_body(BodySlot body) {
    if (!guard_.needs_scaling()) return;
    BodyRow& r = row(body);
    r.velocity = r.base + guard_.scale_of_row()[row_of(body)] * (r.velocity - r.base);
  }
  void turn(BodySlot body);
  void finish(BodySlot body);

  JointStep step_bodies() const { return {solver_.root_W_, solver_.kinematic_rows_}; }
  /// Finds beta from the energy of a sweep's changes.
  void find_beta() {
    double energy = 0;
    for (const float of_manifold : solver_.energy_) energy += double{of_manifold};
    beta_ = static_cast<float>(nncg_.beta(energy));
  }

  ContactSolver& solver_;
  ContactBlocks& blocks_;
  EnergyGuard& guard_;
  const StepContext& step_;
  Bodies& bodies_;
  Joints& joints_;
  BodyRow* rows_;
  bool accelerated_, guarded_;
  Wide gravity_;  ///< Change of a row's velocity by gravity in a substep.
  /// Excess of a substep's displacement at its final velocity over that of a parabola.
  Wide half_fall_;
  ContactStep contact_step_;
  std::vector<Stage> stages_;
  bool rebounds_on_ = false;
  std::atomic<int> any_rebound_ = 0;  ///< 1: a contact rebounded in this round.
  Nncg nncg_;
  float beta_ = 0;
};

void ContactSolver::Stages::plan() {
  const auto free = static_cast<std::uint32_t>(solver_.free_bodies_.size());
  stages_.push_back({{0, free, kBodyGrain}, [this](std::uint32_t begin, std::uint32_t end) {
                       for (std::uint32_t i = begin; i < end; ++i)
                         move_freely(step_, solver_.free_bodies_[i], bodies_);
                     }});
  if (solver_.active_.empty()) return;
  const bool joints = !solver_.joint_solver_.empty(), impacts = !solver_.impact_pass_.empty();
  const bool joined = joints || guarded_;  // before gravity is added, as stages between need it
  each_body<&Stages::begin>();
  each_block<&ContactBlocks::prepare>();
  if (impacts) once([this] { solver_.impact_pass_.prepare(contact_step_, blocks_); });
  each_joint_group([this](auto i) {
    solver_.joint_solver_.begin(i, step_, bodies_, joints_, step_bodies(), rows_);
  });
  for (int s = 0; s < step_.substeps; ++s) {
    if (s == 0) {
      each_body<&Stages::add_first_gravity>();
      each_joint_group<&JointSolver::warm_start>();
      each_color<&ContactBlocks::warm_start>();
      join_if_split();
      if (solver_.moving_) each_block<&ContactBlocks::update_arms>();
    } else {
      joined ? each_body<&Stages::add_gravity>() : each_body<&Stages::join_and_add_gravity>();
      if (solver_.moving_) each_color<&ContactBlocks::apply_arm_change>(), join_if_split();
    }
    plan_restitution();
    if (impacts) once([this] { solver_.impact_pass_.run(contact_step_, blocks_); });
    plan_sweeps<&JointSolver::solve_biased, &ContactBlocks::sweep_biased>(false);
    each_body<&Stages::join_and_move>();
    if (!solver_.kinematic_.empty()) {
      once([this] {
        for (BodyRow* r = solver_.rows_.data(); r < rows_; ++r)
          r->position += static_cast<float>(step_.h_s) * r->velocity;
      });
    }
    if (solver_.moving_) each_block<&ContactBlocks::update_arms>();
    each_joint_group<&JointSolver::refresh>();
    plan_sweeps<&JointSolver::solve_relaxed, &ContactBlocks::sweep_relaxed>(true);
    if (joined || s + 1 == step_.substeps) join_if_split();
    each_joint_group<&JointSolver::break_overloaded>();
    if (guarded_) plan_energy_guard();
  }
  each_block<&ContactBlocks::store>();
  each_body<&Stages::turn>();
  if (guarded_) once([this] { guard_.sum_requests(solver_.active_); });
  each_body<&Stages::finish>();
  if (!joints) return;
  each_body<&Stages::load_body>();
  each_joint_group([this](auto i) {
    solver_.joint_solver_.solve_final(i, step_, bodies_, joints_, step_bodies(), rows_);
  });
  each_body<&Stages::store_body>();
}

/// Plans the sweeps of a substep. After all sweeps but the last, split bodies are joined; after
/// the last one join_and_move() and join_and_add_gravity() do that, which saves a stage.
template <auto solve_joints, auto sweep>
void ContactSolver::Stages::plan_sweeps(bool sum_impulses) {
  for (int i = 1; i <= solver_.options_.sweeps; ++i) {
    const bool last = i == solver_.options_.sweeps, first = i == 1;
    if (accelerated_ && !last)
      each_block([this](auto begin, auto end) { blocks_.save_impulses(begin, end); });
    each_joint_group<solve_joints>();
    each_color([this, sums = sum_impulses && last](auto begin, auto end) {
      (blocks_.*sweep)(begin, end, contact_step_);
      if (sums) blocks_.sum_impulses(begin, end);
    });
    if (last) break;
    join_if_split();
    if (!accelerated_) continue;
    each_block([this](auto begin, auto end) {
      blocks_.find_change_energy(begin, end, solver_.energy_.data());
    });
    once([this, first] {
      if (first) nncg_ = {};
      find_beta();
    });
    each_color([this](auto begin, auto end) {
      blocks_.step_along_direction(begin, end, contact_step_, beta_);
    });
  }
}

/// Plans the restitution before the sweeps, which remove all closing speed. A round follows one
/// that had a rebound: a struck body may now meet a neighbour.
void ContactSolver::Stages::plan_restitution() {
  if (!solver_.order_.bouncy() || !solver_.moving_) return;
  for (int round = 0; round < kRestitutionRounds; ++round) {
    once([this, round] { rebounds_on_ = any_rebound_.exchange(0) != 0 || round == 0; });
    each_color([this](auto begin, auto end) {
      if (rebounds_on_ && blocks_.apply_restitution(begin, end, contact_step_)) any_rebound_ = 1;
    });
  }
}

void ContactSolver::Stages::plan_energy_guard() {
  each_body<&Stages::record_impulse_work>();
  once([this] { guard_.find_impulse_scales(solver_.active_); });
  each_body<&Stages::scale_body>();
  if (solver_.moving_) {
    each_color([this](auto begin, auto end) {
      if (guard_.needs_scaling())
        blocks_.record_spin_change(begin, end, contact_step_, guard_.scale_of_row());
    });
  }
  each_block([this](auto begin, auto end) {
    if (guard_.needs_scaling()) blocks_.scale_impulses(begin, end, guard_.scale_of_row());
  });
  each_joint_group([this](auto i) {
    if (guard_.needs_scaling())
      solver_.joint_solver_.scale_impulses(i, step_, guard_.scale_of_row(), rows_);
  });
}

void ContactSolver::Stages::begin(BodySlot body) {
  // A body that only joints hold uses the angular velocity at the middle of the step.
  solver_.spins_.begin(step_, body, solver_.joint_solver_.hangs_free(body), bodies_);
  load_body(body);
}

void ContactSolver::Stages::turn(BodySlot body) {
  const double gained_J =
      solver_.spins_.end(step_, body, row(body), solver_.root_W_[body], bodies_);
  if (guarded_)
    guard_.request_rotation_energy(body, gained_J, bodies_.inverse_mass[body], row(body));
}

void ContactSolver::Stages::finish(BodySlot body) {
  const BodyRow& r = row(body);
  const Mat3f& root_W = solver_.root_W_[body];
  const bool keeps_angular_momentum =
      guarded_ ? guard_.may_keep_angular_momentum(body) : !solver_.spins_.gains_energy(body);
  if (!keeps_angular_momentum) solver_.spins_.keep_energy(body, r, root_W, bodies_);
  const RotationState& rotation = solver_.spins_.state(body);
  // Only the change is added, so that the doubles keep what no contact changed.
  bodies_.velocity[body] += linear(r.velocity - r.start).cast<double>();
  bodies_.angular_velocity[body] = rotation.w_W;
  bodies_.rotation_path_m[body] +=
      1.1 * double{(root_W * angular(r.position)).norm()} * bodies_.reach_m[body];
  bodies_.place(body, bodies_.position[body] + linear(r.position).cast<double>(), rotation.R_WB);
}

ContactSolver::ContactSolver(const ContactSolverOptions& options)
    : options_(options), blocks_(make_contact_blocks(options.lanes)) {}

ContactSolveReport ContactSolver::solve(const StepContext& step, Bodies& bodies, Contacts& contacts,
                                        Joints& joints) {
  order_.collect(step, bodies, contacts, options_.sweeps < ImpactPass::kMostSweeps);
  make_blocks();
  splitting_.split(order_.manifolds().subspan(order_.first_split()), bodies, contacts);
  const bool accelerated = options_.accelerated && options_.sweeps > 1 && splitting_.empty();
  if (accelerated) blocks_->allocate_search();
  energy_.resize(accelerated ? order_.manifolds().size() : 0);
  joint_solver_.collect(bodies, joints, order_.in_contact());
  collect_bodies(bodies);
  moving_ = !kinematic_.empty() || std::ranges::any_of(active_, [&](BodySlot body) {
    return bodies.velocity[body].norm() * step.dt_s > double{kArmMotion} * bodies.reach_m[body];
  });
  blocks_->allocate_arms(moving_);
  impact_pass_.begin(order_.impacts(), active_, rows_.size(), kinematic_.size(), *blocks_);
  energy_guard_.collect(step, order_.manifolds(), active_, joint_solver_.joined(),
                        joint_solver_.driven(), bodies, contacts);
  Stages(*this, step, bodies, contacts, joints).run();
  const Vec3 from_joints_Ns = joint_solver_.finish(bodies, joints);
  LimitsHit limits;
  limits[Limit::kImpactSweeps] = impact_pass_.was_cut_off();
  limits[Limit::kJointBand] = joint_solver_.was_split();
  return {blocks_->outside_impulse_Ns() + from_joints_Ns,
          blocks_->work(),
          static_cast<std::uint32_t>(order_.manifolds().size()),
          order_.points(),
          !joint_solver_.empty(),
          limits};
}

void ContactSolver::make_blocks() {
  blocks_->clear(order_.manifolds().size());
  colors_.clear();
  impact_pass_.clear();
  const std::uint32_t grain = kManifoldGrain / blocks_->lanes();
  bool was_narrow = false;
  for (std::uint32_t color = 0; color < order_.colors(); ++color) {
    const bool split = color + 1 == order_.colors();
    const std::uint32_t first = blocks_->size();
    blocks_->add(order_.begin(color, true), order_.count(color, true), split);
    impact_pass_.add(first, blocks_->size(), order_.begin(color, true), order_.count(color, true));
    blocks_->add(order_.begin(color, false), order_.count(color, false), split);
    const std::uint32_t count = blocks_->size() - first;
    if (count == 0) continue;
    // Consecutive colours of less than a grain each run in one thread.
    const bool narrow = count <= grain && !split;
    if (narrow && was_narrow) {
      colors_.back().grain = colors_.back().count += count;
    } else {
      colors_.push_back({first, count, grain});
    }
    was_narrow = narrow;
  }
}

void ContactSolver::collect_bodies(const Bodies& bodies) {
  load_kinematic_rows(bodies, {kinematic_, kinematic_rows_, rows_, root_W_});
  spins_.resize(static_cast<std::uint32_t>(bodies.size()));
  active_.clear();
  free_bodies_.clear();
  for (const BodySlot body : bodies.slots())
    if (bodies.awake(body)) (order_.in_contact()[body] ? active_ : free_bodies_).push_back(body);
}

}  // namespace sunder::solver
