// Vectors of four numbers, of which the first three are a 3-vector and the last is zero. Only this
// file of fracture/ uses vector extensions. All operations are IEEE and lane by lane.
#pragma once

#include "engine/base/types.h"

namespace sunder::fracture {

template <class Real>
struct Lanes {
  typedef Real Simd4 __attribute__((vector_size(4 * sizeof(Real))));
};
/// Four numbers of type `Real`, float or double.
template <class Real>
using Simd4 = typename Lanes<Real>::Simd4;

/// Returns four copies of a number.
template <class Real>
Simd4<Real> splat(Real x) {
  return Simd4<Real>{x, x, x, x};
}
/// Returns a vector with a fourth lane of zero.
template <class Real>
Simd4<Real> simd4(const Vec3& v) {
  return Simd4<Real>{static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z()),
                     0};
}
/// Returns the first three lanes.
template <class Q>
Vec3 vec3(Q q) {
  return {q[0], q[1], q[2]};
}
/// Returns the sum of all lanes, from the first to the last.
template <class Q>
double sum(Q q) {
  return q[0] + q[1] + q[2] + q[3];
}

/// Return the first three lanes rotated by one and by two; the fourth lane stays.
template <class Q>
Q yzx(Q q) {
  return __builtin_shufflevector(q, q, 1, 2, 0, 3);
}
template <class Q>
Q zxy(Q q) {
  return __builtin_shufflevector(q, q, 2, 0, 1, 3);
}
/// Returns the cross product of the first three lanes; the fourth is zero if it is in both.
template <class Q>
Q cross(Q a, Q b) {
  return yzx(Q(a * yzx(b) - yzx(a) * b));
}

/// A symmetric 3×3 matrix; the fourth lanes are free for the caller.
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

/// Returns the sum of the dot products of both parts.
template <class Real>
double dot(const Six<Real>& x, const Six<Real>& y) {
  return sum(Simd4<Real>(x.linear * y.linear + x.angular * y.angular));
}

}  // namespace sunder::fracture
