// Solves the contacts and joints of a step: coloured projected Gauss-Seidel in soft substeps, mass
// splitting for what finds no colour. Read first: ContactSolver::solve(), the list of stages.
#pragma once

#include <memory>
#include <vector>

#include "engine/base/nncg.h"
#include "solver/base/stage_runner.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/contact_blocks.h"
#include "solver/rigid/contact/energy_guard.h"
#include "solver/rigid/contact/prepare.h"
#include "solver/rigid/joint/joint_solver.h"

namespace sunder::solver {

/// What a solve did to bodies in contact.
struct ContactSolveReport {
  Vec3 outside_impulse_Ns = Vec3::Zero();  ///< On bodies, from what cannot move.
  std::uint32_t manifolds = 0;
  std::uint32_t points = 0;
};

/// How contacts are solved.
struct ContactSolverOptions {
  int sweeps = 1;  ///< Of either kind in a substep.
  /// Sweeps are steps of conjugate gradients (nncg.h). Plain where bodies are split.
  bool accelerated = false;
  int lanes = 0;  ///< Most to be used; 0: what the processor has. The same bits for any.
};

class ContactSolver {
 public:
  explicit ContactSolver(const ContactSolverOptions& options = {});

  /// Moves every awake body by dt_s: those in contact by substeps, the others by free flight.
  /// Joints that bear too much go.
  ContactSolveReport solve(double dt_s, int substeps, const Vec3& gravity_W, Bodies& bodies,
                           Contacts& contacts, Joints& joints);

  /// Substep of the impulses that manifolds keep; 0: none solved yet.
  double last_h_s() const { return last_h_s_; }

 private:
  void collect_blocks(const Bodies& bodies, const Contacts& contacts);
  void split_bodies(const Bodies& bodies, const Contacts& contacts);
  void collect_bodies(const Bodies& bodies);
  std::vector<Stage> plan(int substeps) const;
  void begin_body(std::uint32_t body, double dt_s, Bodies& bodies);
  void join_parts(std::uint32_t body);
  void finish_body(std::uint32_t body, Bodies& bodies) const;

  JointSolver joint_solver_;
  EnergyGuard energy_guard_;
  ContactSolverOptions options_;
  std::unique_ptr<ContactBlocks> blocks_;
  std::vector<Stage> colors_;            ///< Where each colour's blocks are; what is split last.
  std::vector<std::uint32_t> touching_;  ///< Manifolds to solve, by colour and point count.
  std::vector<std::uint32_t> active_;    ///< Awake bodies in contact.
  std::vector<std::uint32_t> flying_;    ///< Awake bodies that touch nothing.
  std::vector<std::uint8_t> in_contact_;
  std::vector<std::uint8_t> jointed_;          ///< By body slot: held by a joint.
  std::vector<std::uint8_t> loaded_contacts_;  ///< Loaded manifolds by body slot, at most 3.
  std::vector<std::uint32_t> deep_contacts_;   ///< By body slot; empty if there are none.
  std::vector<BodyRow> rows_;                  ///< By body slot + 1; row 0 stays still.
  std::vector<Mat3f> root_W_;
  std::uint32_t points_ = 0;

  void choose_beta(bool first);
  bool accelerated_ = false;   ///< In this step.
  std::vector<float> energy_;  ///< Of the last sweep's changes, by manifold.
  Nncg nncg_;
  float beta_ = 0;
  double last_h_s_ = 0;

  // Mass splitting: manifolds that found no colour are solved side by side, and what they do to a
  // body is summed in the order of its parts.
  std::uint32_t first_split_ = 0;          ///< In `touching_`.
  std::vector<SplitSides> split_;          ///< By manifold from there on.
  std::vector<std::uint32_t> part_count_;  ///< By body slot.
  std::vector<std::uint32_t> part_end_;    ///< By body slot, of its parts; 0 if it has none.
  std::vector<Wide> parts_;
};

}  // namespace sunder::solver
