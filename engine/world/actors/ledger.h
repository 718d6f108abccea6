// What the running world counts and weighs, for the next frame. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/frame.h"
#include "engine/model/physics.h"
#include "engine/model/work_log.h"

namespace sunder {

struct Ledger {
  FrameReport report;              ///< Of the frame under way.
  std::vector<BreakEvent> breaks;  ///< Of the frame under way.
  WorkLog work;                    ///< Of the frame under way.
  double debris_mass_kg = 0;       ///< Of all that became too small for a body.
  double removed_mass_kg = 0;      ///< By the script.
  double plastic_J = 0;            ///< That bending took, of the whole run.
  double kinetic_J = 0;            ///< At the end of the last frame.
  double momentum_error_Ns = 0, momentum_moved_Ns = 0;  ///< Of the frame under way.

  /// What a solve did, of a step in which gravity changes velocities by `fall_m_s`. Momentum that
  /// came neither from gravity nor from static bodies is an error.
  void note(const SolveReport& solved, double fall_m_s) {
    momentum_error_Ns +=
        (solved.momentum_after_Ns - solved.momentum_before_Ns - solved.external_impulse_Ns).norm();
    // At rest weight and support cancel: what changed hands is the weight, not the sum of both.
    momentum_moved_Ns += solved.momentum_before_Ns.norm() + solved.mass_kg * fall_m_s;
    report.energy += solved.energy;
    report.friction_allowed_Ns += solved.friction_allowed_Ns;
    report.friction_excess_Ns += solved.friction_excess_Ns;
    report.counts.contacts = solved.contacts;
    report.frozen += solved.frozen;
  }
  /// Bending takes energy of joints that a solve has booked as that of joints.
  void note_bending(double work_J) {
    plastic_J += work_J;
    report.energy.bending += work_J;
  }
  /// Ends the frame under way: what its report says of energy and momentum. In the first frame all
  /// motion is the scene's.
  void close(FrameReport& frame, bool is_first) {
    if (is_first) frame.energy.script = frame.kinetic_J;
    frame.energy_residual_J = frame.kinetic_J - kinetic_J - frame.energy.sum();
    kinetic_J = frame.kinetic_J;
    frame.plastic_J = plastic_J;
    frame.momentum_residual = momentum_moved_Ns > 0 ? momentum_error_Ns / momentum_moved_Ns : 0;
    momentum_error_Ns = momentum_moved_Ns = 0;
  }
};

}  // namespace sunder
