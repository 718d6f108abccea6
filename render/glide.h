// How a camera comes to where it should be: soon, and without a jerk.
#pragma once

#include "engine/base/types.h"

namespace sunder::render {

/// What is drawn to a goal by a critically damped spring: its velocity has no jumps, whatever the
/// goal does, and behind a goal of constant velocity it does not lag.
template <class Vector>
struct Glide {
  Vector at;
  Vector velocity;  ///< A second.

  /// To where it is after dt_s, when the goal is at `goal` and has come there at `pace`; `rate` is
  /// by how much the way to it shrinks in a second, about, as a power of e.
  void on(const Vector& goal, const Vector& pace, double dt_s, double rate) {
    const double x = rate * dt_s;
    const double left = 1 / (1 + x * (1 + x * (0.5 + x / 6)));  // exp(-x), the same everywhere
    const Vector off = at - (goal - dt_s * pace);
    const Vector drift = velocity - pace + rate * off;
    at = goal + left * (off + dt_s * drift);
    velocity = pace + left * (drift - rate * (off + dt_s * drift));
  }
};

}  // namespace sunder::render
