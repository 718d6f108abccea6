// Record of a run: the report, breaks and counts of the current frame, and sums of mass, energy and
// momentum. Internal to engine/world.
#pragma once

#include <vector>

#include "engine/model/frame.h"
#include "engine/model/physics.h"
#include "engine/model/work_log.h"

namespace sunder {

struct RunLog {
  FrameReport report;              ///< Report of the current frame.
  std::vector<BreakEvent> breaks;  ///< Breaks of the current frame.
  WorkLog work_counts;             ///< Items and times of the stages of the current frame.
  double debris_mass_kg = 0;       ///< Mass of all pieces too small for a body.
  double removed_mass_kg = 0;      ///< Mass removed by the script.
  double plastic_J = 0;            ///< Plastic work of the whole run.
  double kinetic_J = 0;            ///< Kinetic energy at the end of the last frame.
  double momentum_error_Ns = 0, momentum_moved_Ns = 0;  ///< Sums of the current frame.

  /// Adds the report of a solve, in whose step gravity changes velocities by `fall_m_s`. Changes of
  /// momentum by neither gravity nor static bodies are errors.
  void add_solve(const SolveReport& solved, double fall_m_s) {
    momentum_error_Ns +=
        (solved.momentum_after_Ns - solved.momentum_before_Ns - solved.external_impulse_Ns).norm();
    // The weight of resting bodies counts, though weight and support cancel in the momentum.
    momentum_moved_Ns += solved.momentum_before_Ns.norm() + solved.mass_kg * fall_m_s;
    report.energy += solved.energy;
    report.friction_allowed_Ns += solved.friction_allowed_Ns;
    report.friction_excess_Ns += solved.friction_excess_Ns;
    report.counts.contacts = solved.contacts;
    report.frozen += solved.frozen;
    report.limits += solved.limits;
  }
  /// Adds plastic work of hinges, which the solve has counted as energy of joints.
  void add_plastic_work(double work_J) {
    plastic_J += work_J;
    report.energy.bending += work_J;
  }
  /// Ends the current frame: completes the energy and momentum of its report, whose sums over
  /// bodies are known. In the first frame all kinetic energy is the scene's.
  void end_frame(bool is_first) {
    if (is_first) report.energy.script = report.kinetic_J;
    report.energy_residual_J = report.kinetic_J - kinetic_J - report.energy.sum();
    kinetic_J = report.kinetic_J;
    report.plastic_J = plastic_J;
    report.momentum_residual = momentum_moved_Ns > 0 ? momentum_error_Ns / momentum_moved_Ns : 0;
    momentum_error_Ns = momentum_moved_Ns = 0;
  }
};

}  // namespace sunder
