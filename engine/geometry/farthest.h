// The extreme point by a measure.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "engine/base/types.h"

namespace sunder {

/// Returns the index of the first point of greatest `measure(point)`; 0 if there are no points.
template <class Measure>
std::uint32_t farthest(std::span<const Vec3> points, const Measure& measure) {
  std::uint32_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (const double m = measure(points[i]); m > most) {
      best = i;
      most = m;
    }
  }
  return best;
}

}  // namespace sunder
