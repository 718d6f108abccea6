// Between the keys of paths: Hermite's cubics, with the slopes of Fritsch and Butland (1984), which
// make each component monotone from key to key.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// The slope where lines of these slopes meet, that long: 0 where a component turns back or stays.
template <class Vector>
Vector slope_between(const Vector& before, double before_s, const Vector& after, double after_s) {
  const double weight = (before_s + 2 * after_s) / (3 * (before_s + after_s));
  Vector slope = Vector::Zero();
  for (Eigen::Index i = 0; i < slope.size(); ++i) {
    const double product = before[i] * after[i];
    if (product > 0) slope[i] = product / (weight * after[i] + (1 - weight) * before[i]);
  }
  return slope;
}

/// By how much a cubic is off the straight line of slope `line`, `s` (0 to 1) of the way along it,
/// with these slopes at its ends; for a way that takes a second.
template <class Vector>
Vector bow(double s, const Vector& line, const Vector& begin, const Vector& end) {
  return s * (1 - s) * ((1 - s) * (begin - line) - s * (end - line));
}

}  // namespace sunder
