// How far a point is from a box.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// From a box to a point, in m²; zero within.
inline double squared_distance(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

}  // namespace sunder
