// Distance of a point from a box.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Returns the squared distance from a box to a point, in m²; 0 if the point is inside.
inline double squared_distance(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
}

}  // namespace sunder
