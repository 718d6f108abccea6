// Constants of a step for all parts of the solver.
#pragma once

#include <algorithm>

#include "engine/base/froude.h"
#include "engine/base/types.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {

/// Made once before a step and passed down. The number of substeps is known only for the solve;
/// before that, values of a substep are those of a step of one substep.
struct StepContext {
  StepContext(const Vec3& gravity, double dt, int parts = 1)
      : gravity_W(gravity),
        froude(gravity),
        dt_s(dt),
        substeps(parts),
        h_s(dt / parts),
        inverse_h(static_cast<float>(1 / h_s)),
        gravity_dv_W((h_s * gravity).cast<float>()),
        fall_m_s(gravity.norm() * dt),
        fall_m(static_cast<float>(fall_m_s * dt)),
        rest_speed_m_s(froude.rest_speed_m_s(dt)) {}

  /// Time that a body must have been at rest to fall asleep, s.
  double rest_s(double reach_m) const {
    return std::max(kMinRestTime * froude.time_s(reach_m), kMinRestSteps * dt_s);
  }

  Vec3 gravity_W;
  FroudeScale froude;
  double dt_s;
  int substeps;
  double h_s;             ///< Length of a substep.
  float inverse_h;        ///< 1/s.
  Vec3f gravity_dv_W;     ///< Change of velocity by gravity in a substep.
  double fall_m_s;        ///< Change of speed by gravity in the step.
  float fall_m;           ///< Distance that gravity moves a body at rest in one step, g·dt².
  double rest_speed_m_s;  ///< Closing speed below which a contact is at rest.
};

}  // namespace sunder::solver
