// Access to one lane of a wide vector as a Vec3f.
#pragma once

#include "engine/base/types.h"
#include "solver/base/wide.h"

namespace sunder::solver {

/// Returns a vector with the same value in all lanes.
SUNDER_INLINE Wide3 splat3(const Vec3f& v) { return {splat(v.x()), splat(v.y()), splat(v.z())}; }

template <class V>
void set_lane(Triple<V>& wide, std::uint32_t lane, const Vec3f& v) {
  wide.x[lane] = v.x();
  wide.y[lane] = v.y();
  wide.z[lane] = v.z();
}

template <class V>
Vec3f lane_of(const Triple<V>& wide, std::uint32_t lane) {
  return {wide.x[lane], wide.y[lane], wide.z[lane]};
}

}  // namespace sunder::solver
