// Smooth following of a moving target by a critically damped spring, for cameras.
#pragma once

#include "engine/base/types.h"

namespace sunder::render {

/// A point attached to a goal by a critically damped spring. Its velocity is continuous even if the
/// goal jumps, and it does not lag behind a goal of constant velocity.
template <class Vector>
struct DampedSpring {
  Vector position;
  Vector velocity;  ///< Velocity, per second.

  /// Advances by dt_s towards a goal that has arrived at `goal` with the velocity `goal_velocity`.
  /// The distance decays by about exp(-rate) per second.
  void advance(const Vector& goal, const Vector& goal_velocity, double dt_s, double rate) {
    const double x = rate * dt_s;
    const double left = 1 / (1 + x * (1 + x * (0.5 + x / 6)));  // about exp(-x), without libm
    const Vector off = position - (goal - dt_s * goal_velocity);
    const Vector drift = velocity - goal_velocity + rate * off;
    position = goal + left * (off + dt_s * drift);
    velocity = goal_velocity + left * (drift - rate * (off + dt_s * drift));
  }
};

}  // namespace sunder::render
