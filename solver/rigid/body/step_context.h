// What a step is to every part of the solver.
#pragma once

#include <algorithm>

#include "engine/base/froude.h"
#include "engine/base/types.h"
#include "solver/rigid/tolerances.h"

namespace sunder::solver {

/// Made once before anything is found or moved, and handed down. Before the solve nobody knows into
/// how many substeps it will be cut: what is of substeps is then as if of one.
struct StepContext {
  /// `last_h_s`: the substep of the impulses that contacts and joints keep; 0: they keep none.
  StepContext(const Vec3& gravity, double dt, int parts = 1, double last_h_s = 0)
      : gravity_W(gravity),
        froude(gravity),
        dt_s(dt),
        substeps(parts),
        h_s(dt / parts),
        inverse_h(static_cast<float>(1 / h_s)),
        kick_W((h_s * gravity).cast<float>()),
        fall_m_s(gravity.norm() * dt),
        fall_m(static_cast<float>(fall_m_s * dt)),
        still_m_s(froude.still_m_s(dt)) {
    const double scale = last_h_s > 0 ? h_s / last_h_s : 1;
    impulse_scale = static_cast<float>(scale);
    kept_scale = static_cast<float>(1 / scale);
  }

  /// Time that a body must have been at rest to fall asleep.
  double rest_s(double reach_m) const {
    return std::max(kRestTime * froude.time_s(reach_m), kRestSteps * dt_s);
  }

  Vec3 gravity_W;
  FroudeScale froude;
  double dt_s;
  int substeps;
  double h_s;               ///< Of a substep.
  float inverse_h;          ///< 1/s.
  Vec3f kick_W;             ///< What gravity does to a velocity in a substep.
  double fall_m_s;          ///< What gravity does to a speed within the step,
  float fall_m;             ///< and to a way.
  double still_m_s;         ///< What closes more slowly rests.
  float impulse_scale = 1;  ///< From impulses that are kept to those of a substep,
  float kept_scale = 1;     ///< and back.
};

}  // namespace sunder::solver
