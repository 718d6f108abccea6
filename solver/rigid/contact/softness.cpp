#include "solver/rigid/contact/softness.h"

#include <numbers>

#include "solver/rigid/body/step_context.h"

namespace sunder::solver {
namespace {

// Contact frequency times substep, by the number of points less one: see docs/decisions/003. Two
// sweeps keep up with 0.25 where pieces touch in a point or two, as rubble does. Faces that meet in
// four are four springs side by side, and friction as stiff as they are makes a standing wave of a
// wall.
constexpr double kPressStiffness[4] = {0.25, 0.25, 0.2, 0.18};
constexpr double kSlideStiffness[4] = {0.25, 0.25, 0.125, 0.125};
constexpr double kDampingRatio = 5;  // to critical
constexpr double kPush = 4;          // fastest correction of an overlap, in speeds of falling

/// A spring of (omega·h)² of the mass over h²; what it gives way under an impulse p a substep is
/// p / (mass · h) / omega².
Softness softness(double stiffness, double h) {
  const double omega_h = 2 * std::numbers::pi * stiffness;
  const double a1 = 2 * kDampingRatio + omega_h, a2 = omega_h * a1, a3 = 1 / (1 + a2);
  return {static_cast<float>(omega_h / h / a1), static_cast<float>(a2 * a3), static_cast<float>(a3),
          static_cast<float>(h / (omega_h * omega_h))};
}

}  // namespace

SoftStep soft_step(const StepContext& step) {
  SoftStep soft;
  for (int i = 0; i < 4; ++i) {
    soft.press[i] = softness(kPressStiffness[i], step.h_s);
    soft.slide[i] = softness(kSlideStiffness[i], step.h_s);
  }
  soft.inverse_h = step.inverse_h;
  soft.push = static_cast<float>(kPush * step.froude.speed_m_s(1));
  return soft;
}

}  // namespace sunder::solver
