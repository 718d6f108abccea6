#include "solver/rigid/contact/kernels/softness.h"

#include <numbers>

#include "solver/rigid/body/step_context.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// Returns the softness of a spring of stiffness mass·omega². An impulse p per substep compresses
/// it by p / (mass·h·omega²).
Softness softness(double stiffness, double h) {
  const double omega_h = 2 * std::numbers::pi * stiffness;
  const double a1 = 2 * kDampingRatio + omega_h, a2 = omega_h * a1, a3 = 1 / (1 + a2);
  return {static_cast<float>(omega_h / h / a1), static_cast<float>(a2 * a3), static_cast<float>(a3),
          static_cast<float>(h / (omega_h * omega_h))};
}

}  // namespace

SoftStep soft_step(const StepContext& step) {
  SoftStep soft;
  soft.edge = {softness(kPointStiffness, step.h_s), softness(kPointStiffness, step.h_s)};
  soft.face = {softness(kFaceStiffness, step.h_s), softness(0.5 * kPointStiffness, step.h_s)};
  soft.inverse_h = step.inverse_h;
  soft.push = static_cast<float>(kMaxPushSpeed * step.froude.speed_m_s(1));
  soft.landing_m_s = static_cast<float>(kLandingSpeed * step.fall_m_s / step.substeps);
  return soft;
}

}  // namespace sunder::solver
