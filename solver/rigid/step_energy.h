// Changes of the kinetic energy of awake bodies in a solve, by cause.
#pragma once

#include "engine/model/energy.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/contact/contact_solver.h"

namespace sunder::solver {

/// Returns the energy flows of a step from the motion before and after it, and the measured work.
/// The remainder is assigned to joints, or to contacts if there are no joints: lever arms and
/// Jacobians turn within a step, so the work of an impulse follows only from the motion.
inline EnergyFlows energy_of(const ContactSolveReport& solved, const StepContext& step,
                             const Momentum& start, const Momentum& end) {
  EnergyFlows energy;
  energy.gravity = 0.5 * step.dt_s * step.gravity_W.dot(start.momentum_Ns + end.momentum_Ns);
  energy.drives = solved.work.drive_J;
  energy.friction = -solved.work.friction_J;
  if (solved.joints) energy.contacts = -solved.work.normal_J;
  const double left_J = start.kinetic_J + energy.sum() - end.kinetic_J;
  (solved.joints ? energy.joints : energy.contacts) = left_J;
  return energy;
}

}  // namespace sunder::solver
