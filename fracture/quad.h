// Four doubles at a time, of which the first three are a vector and the last is zero: the only
// place of this room with vector extensions. Every operation is IEEE and lane by lane.
#pragma once

#include "engine/base/types.h"

namespace sunder::fracture {

typedef double Quad __attribute__((vector_size(32)));

inline Quad splat(double x) { return Quad{x, x, x, x}; }
inline Quad quad(const Vec3& v) { return Quad{v.x(), v.y(), v.z(), 0}; }
inline Vec3 vec3(Quad q) { return {q[0], q[1], q[2]}; }
inline double sum(Quad q) { return q[0] + q[1] + q[2] + q[3]; }

inline Quad yzx(Quad q) { return __builtin_shufflevector(q, q, 1, 2, 0, 3); }
inline Quad zxy(Quad q) { return __builtin_shufflevector(q, q, 2, 0, 1, 3); }
inline Quad cross(Quad a, Quad b) { return yzx(a * yzx(b) - yzx(a) * b); }

/// A symmetric 3×3 matrix; its fourth lanes are the caller's.
struct Symmetric {
  Quad diagonal;  ///< xx, yy, zz
  Quad rest;      ///< yz, xz, xy

  Symmetric() = default;
  explicit Symmetric(const Mat3& m)
      : diagonal{m(0, 0), m(1, 1), m(2, 2), 0}, rest{m(1, 2), m(0, 2), m(0, 1), 0} {}
  Quad operator*(Quad v) const { return diagonal * v + zxy(rest) * yzx(v) + yzx(rest) * zxy(v); }
};

/// A translation and a rotation, or a force and a torque.
struct Six {
  Quad linear{}, angular{};
};

inline double dot(const Six& x, const Six& y) {
  return sum(x.linear * y.linear + x.angular * y.angular);
}

}  // namespace sunder::fracture
