// Four numbers at a time, of which the first three are a vector and the last is zero: the only
// place of this room with vector extensions. Every operation is IEEE and lane by lane.
#pragma once

#include "engine/base/types.h"

namespace sunder::fracture {

template <class Real>
struct Lanes {
  typedef Real Simd4 __attribute__((vector_size(4 * sizeof(Real))));
};
/// Four of `Real`, float or double.
template <class Real>
using Simd4 = typename Lanes<Real>::Simd4;

/// The same number four times.
template <class Real>
Simd4<Real> splat(Real x) {
  return Simd4<Real>{x, x, x, x};
}
/// A vector, its fourth lane zero.
template <class Real>
Simd4<Real> simd4(const Vec3& v) {
  return Simd4<Real>{static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z()),
                     0};
}
/// The first three lanes.
template <class Q>
Vec3 vec3(Q q) {
  return {q[0], q[1], q[2]};
}
/// Of all lanes, from the first.
template <class Q>
double sum(Q q) {
  return q[0] + q[1] + q[2] + q[3];
}

/// The first three lanes rotated by one, and by two; the fourth stays.
template <class Q>
Q yzx(Q q) {
  return __builtin_shufflevector(q, q, 1, 2, 0, 3);
}
template <class Q>
Q zxy(Q q) {
  return __builtin_shufflevector(q, q, 2, 0, 1, 3);
}
/// The cross product of the first three lanes; the fourth is zero if both are.
template <class Q>
Q cross(Q a, Q b) {
  return yzx(Q(a * yzx(b) - yzx(a) * b));
}

/// A symmetric 3×3 matrix; its fourth lanes are the caller's.
template <class Real>
struct Symmetric {
  Simd4<Real> diagonal{};  ///< xx, yy, zz
  Simd4<Real> rest{};      ///< yz, xz, xy

  Simd4<Real> operator*(Simd4<Real> v) const {
    return diagonal * v + zxy(rest) * yzx(v) + yzx(rest) * zxy(v);
  }
};

/// A translation and a rotation, or a force and a torque.
template <class Real>
struct Six {
  Simd4<Real> linear{}, angular{};
};

/// The sum of products of both parts.
template <class Real>
double dot(const Six<Real>& x, const Six<Real>& y) {
  return sum(Simd4<Real>(x.linear * y.linear + x.angular * y.angular));
}

}  // namespace sunder::fracture
