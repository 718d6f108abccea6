// Solves the contacts and joints of a step: coloured projected Gauss-Seidel in soft substeps, with
// mass splitting for manifolds without a colour. Read first: plan() in contact_solver.cpp, the list
// of stages.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/copied_ptr.h"
#include "engine/model/limits_hit.h"
#include "solver/base/stage_runner.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/spins.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/contact_blocks.h"
#include "solver/rigid/contact/energy_guard.h"
#include "solver/rigid/contact/impact_pass.h"
#include "solver/rigid/contact/mass_splitting.h"
#include "solver/rigid/contact/sweep_order.h"
#include "solver/rigid/joint/joint_solver.h"

namespace sunder::solver {

/// Results of a solve for bodies in contact.
struct ContactSolveReport {
  Vec3 outside_impulse_Ns = Vec3::Zero();  ///< Impulse on bodies from those that cannot move.
  ContactWork work;
  std::uint32_t manifolds = 0;
  std::uint32_t points = 0;
  bool joints = false;  ///< True if joints took part.
  LimitsHit limits;     ///< Limits that were reached, each at most once.
};

/// Options of the contact solver.
struct ContactSolverOptions {
  int sweeps = 1;  ///< Number of biased sweeps, and of relaxed sweeps, per substep.
  /// Accelerates sweeps by conjugate gradients (nncg.h), unless bodies are split.
  bool accelerated = false;
  /// Maximum number of lanes; 0: as many as the processor has. Same bits for any number.
  int lanes = 0;
};

class ContactSolver {
 public:
  explicit ContactSolver(const ContactSolverOptions& options = {});

  /// Moves each awake body by the step: those in contact in substeps, others by free flight.
  /// Removes joints that break.
  ContactSolveReport solve(const StepContext& step, Bodies& bodies, Contacts& contacts,
                           Joints& joints);

 private:
  class Stages;
  void make_blocks();
  void collect_bodies(const Bodies& bodies);

  ContactSolverOptions options_;
  SweepOrder order_;
  MassSplitting splitting_;
  JointSolver joint_solver_;
  EnergyGuard energy_guard_;
  ImpactPass impact_pass_;
  CopiedPtr<ContactBlocks> blocks_;
  std::vector<StageItems> colors_;     ///< Blocks of each colour; split blocks are last.
  std::vector<BodySlot> active_;       ///< Awake bodies in contact or in a joint.
  std::vector<BodySlot> free_bodies_;  ///< Awake bodies without contacts.
  std::vector<BodySlot> kinematic_;    ///< Moving kinematic bodies.
  std::vector<BodyRow> rows_;          ///< Rows by row_of(), after those of kinematic bodies.
  ByBody<std::int32_t> kinematic_rows_;
  ByBody<Mat3f> root_W_;
  Spins spins_;
  bool moving_ = false;  ///< True if a body in contact moves, so that lever arms are updated.
  /// Energy of a sweep's changes, by manifold; empty: no conjugate gradients.
  std::vector<float> energy_;
};

}  // namespace sunder::solver
