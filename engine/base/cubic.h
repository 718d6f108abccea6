// Interpolation between keyframes by Hermite cubics, with the slopes of Fritsch and Butland (1984),
// which make each component monotone between keys.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Returns the slope at a key from those of the chords before and after, of durations `before_s`
/// and `after_s`; 0 in components that turn back or where a chord is level.
template <class Vector>
Vector monotone_slope(const Vector& before, double before_s, const Vector& after, double after_s) {
  const double weight = (before_s + 2 * after_s) / (3 * (before_s + after_s));
  Vector slope = Vector::Zero();
  for (Eigen::Index i = 0; i < slope.size(); ++i) {
    const double product = before[i] * after[i];
    if (product > 0) slope[i] = product / (weight * after[i] + (1 - weight) * before[i]);
  }
  return slope;
}

/// Returns the difference between the Hermite cubic and its chord at `s` (0 to 1), for a segment of
/// 1 s: `chord_slope` is the slope of the chord, `begin_slope` and `end_slope` those at its ends.
template <class Vector>
Vector cubic_offset(double s, const Vector& chord_slope, const Vector& begin_slope,
                    const Vector& end_slope) {
  return s * (1 - s) * ((1 - s) * (begin_slope - chord_slope) - s * (end_slope - chord_slope));
}

}  // namespace sunder
