#include "engine/geometry/inertia.h"

#include <Eigen/Eigenvalues>

namespace sunder {
namespace {

constexpr double kLeastMoment = 1e-4;  // of the largest

PrincipalMoments unbounded_moments(const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (inertia + inertia.transpose()));
  return {solver.eigenvectors(), solver.eigenvalues()};
}

}  // namespace

PrincipalMoments principal_moments(const Mat3& inertia) {
  PrincipalMoments all = unbounded_moments(inertia);
  all.moments = all.moments.cwiseMax(kLeastMoment * all.moments.maxCoeff()).eval();
  return all;
}

Mat3 spinnable(const Mat3& inertia) {
  const Vec3 moments = unbounded_moments(inertia).moments;
  if (moments.minCoeff() >= kLeastMoment * moments.maxCoeff()) return inertia;
  const PrincipalMoments bounded = principal_moments(inertia);
  return bounded.axes * bounded.moments.asDiagonal() * bounded.axes.transpose();
}

}  // namespace sunder
