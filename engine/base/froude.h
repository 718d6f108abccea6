// What is fast and what is soon for a piece of a size. Tolerances of motion follow from these and
// from the step, never from a number of metres, so that pebbles do as boulders do.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/base/types.h"

namespace sunder {

/// Speeds and times of falling (Froude's scaling).
class FroudeScale {
 public:
  explicit FroudeScale(const Vec3& gravity_W)
      : gravity_m_s2_(std::max(kLeastGravity_m_s2, gravity_W.norm())) {}

  /// What is weightless is judged as if it weighed this much.
  static constexpr double kLeastGravity_m_s2 = 1;
  double gravity_m_s2() const { return gravity_m_s2_; }
  /// About what a piece has after falling by its size: √(g·size).
  double speed_m_s(double size_m) const { return std::sqrt(gravity_m_s2_ * size_m); }
  /// About what that takes: √(size/g).
  double time_s(double size_m) const { return std::sqrt(size_m / gravity_m_s2_); }
  /// What a step can hardly tell from rest: a tenth of what gravity does in it.
  double still_m_s(double dt_s) const { return 0.1 * gravity_m_s2_ * dt_s; }

 private:
  double gravity_m_s2_;
};

}  // namespace sunder
