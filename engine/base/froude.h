// Reference speeds and times for bodies of a given size, by Froude scaling. Tolerances of motion
// derive from these and the time step, not from fixed lengths, so that behaviour does not depend on
// scale (decision 034).
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/base/types.h"

namespace sunder {

/// Speeds and times of free fall under the gravity of a scene.
class FroudeScale {
 public:
  explicit FroudeScale(const Vec3& gravity_W)
      : gravity_m_s2_(std::max(kMinGravity_m_s2, gravity_W.norm())) {}

  /// Least gravity used for scaling, in m/s², so that scenes without gravity have tolerances too.
  static constexpr double kMinGravity_m_s2 = 1;
  double gravity_m_s2() const { return gravity_m_s2_; }
  /// Approximate speed of a body that has fallen by its own size: √(g·size).
  double speed_m_s(double size_m) const { return std::sqrt(gravity_m_s2_ * size_m); }
  /// Approximate time in which a body falls by its own size: √(size/g).
  double time_s(double size_m) const { return std::sqrt(size_m / gravity_m_s2_); }
  /// Speed below which a body counts as at rest: 0.1·g·dt, a tenth of what gravity adds in a step.
  double rest_speed_m_s(double dt_s) const { return 0.1 * gravity_m_s2_ * dt_s; }

 private:
  double gravity_m_s2_;
};

}  // namespace sunder
