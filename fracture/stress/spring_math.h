// Arithmetic shared by the parts of the stress solve. Internal to fracture/stress.
#pragma once

#include <limits>

#include <Eigen/Eigenvalues>

#include "engine/base/state_checks.h"
#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// Converts to `Real` and sets coordinates to zero that are rounding errors relative to `size`:
/// their products would be denormal numbers, which are slow.
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

/// Returns the inertia about the origin of a unit mass or stiffness at `arm` (parallel axes).
inline Mat3 parallel_axis(const Vec3& arm) {
  return arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
}

/// Returns the matrix m with m v = arm × v.
inline Mat3 cross_matrix(const Vec3& arm) {
  Mat3 m;
  m << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return m;
}

/// Returns true if a matrix is symmetric, has no negative eigenvalue, but for rounding, and has no
/// element beyond `most`; for saved states.
inline bool is_semidefinite(const Mat3& m, double most) {
  if (!is_within(m, most)) return false;
  const double rounding = 1e-6 * m.norm();
  if ((m - m.transpose()).norm() > rounding) return false;
  Eigen::SelfAdjointEigenSolver<Mat3> axes;
  axes.computeDirect(m, Eigen::EigenvaluesOnly);
  return axes.eigenvalues().minCoeff() >= -rounding;
}

}  // namespace sunder::fracture
