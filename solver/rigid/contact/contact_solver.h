// Solves the contacts and joints of a step: coloured projected Gauss-Seidel in soft substeps, mass
// splitting for what finds no colour. Read first: plan() in contact_solver.cpp, the list of stages.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

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

/// What a solve did to bodies in contact.
struct ContactSolveReport {
  Vec3 outside_impulse_Ns = Vec3::Zero();  ///< On bodies, from what cannot move.
  ContactWork work;
  std::uint32_t manifolds = 0;
  std::uint32_t points = 0;
  bool joints = false;  ///< Joints took part.
};

/// How contacts are solved.
struct ContactSolverOptions {
  int sweeps = 1;  ///< Of either kind in a substep.
  bool accelerated =
      false;      ///< Sweeps go by conjugate gradients: nncg.h. Not where bodies are split.
  int lanes = 0;  ///< Most to be used; 0: what the processor has. The same bits for any.
};

class ContactSolver {
 public:
  explicit ContactSolver(const ContactSolverOptions& options = {});

  /// Moves every awake body by the step: those in contact by substeps, the others by free flight.
  /// Joints that bear too much go.
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
  std::unique_ptr<ContactBlocks> blocks_;
  std::vector<StageItems> colors_;   ///< Where each colour's blocks are; what is split last.
  std::vector<BodySlot> active_;     ///< Awake bodies in contact, or held by a joint.
  std::vector<BodySlot> flying_;     ///< Awake bodies that touch nothing.
  std::vector<BodySlot> kinematic_;  ///< Those on their way.
  std::vector<BodyRow> rows_;        ///< From that of the last of these on: see row_of().
  ByBody<std::int32_t> kinematic_rows_;
  ByBody<Mat3f> root_W_;
  Spins spins_;
  bool moving_ = false;        ///< Some body in contact moves: arms follow.
  std::vector<float> energy_;  ///< Of a sweep's changes, by manifold; none: sweeps go plainly.
};

}  // namespace sunder::solver
