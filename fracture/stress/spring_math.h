// What the stress solve's levels work out of springs. Internal to spring_level.cpp and
// spring_groups.cpp.
#pragma once

#include <limits>

#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// As stored in `Real`, without what is rounding beside `size`: products of such numbers end up
/// below what a processor multiplies fast.
template <class Real>
Simd4<Real> rounded(const Vec3& v, double size) {
  const double least = size * double{std::numeric_limits<Real>::epsilon()};
  return simd4<Real>((v.array().abs() > least).select(v, Vec3::Zero()));
}

template <class Real>
Symmetric<Real> rounded(const Mat3& m) {
  Symmetric<Real> result;
  result.diagonal = simd4<Real>(m.diagonal());
  result.rest = rounded<Real>(Vec3(m(1, 2), m(0, 2), m(0, 1)), m.trace());
  return result;
}

inline Mat3 lever(const Vec3& arm) {
  return arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
}

}  // namespace sunder::fracture
