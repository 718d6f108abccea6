#include "engine/geometry/inertia.h"

#include <Eigen/Eigenvalues>

namespace sunder {
namespace {

/// Least principal moment over the largest.
constexpr double kMinMomentRatio = 1e-4;

PrincipalMoments eigen_moments(const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (inertia + inertia.transpose()));
  return {solver.eigenvectors(), solver.eigenvalues()};
}

Vec3 bounded(const Vec3& moments) { return moments.cwiseMax(kMinMomentRatio * moments.maxCoeff()); }

}  // namespace

PrincipalMoments principal_moments(const Mat3& inertia) {
  const auto [axes, moments] = eigen_moments(inertia);
  return {axes, bounded(moments)};
}

Mat3 bounded_inertia(const Mat3& inertia) {
  const auto [axes, moments] = eigen_moments(inertia);
  const Vec3 raised = bounded(moments);
  return raised == moments ? inertia : Mat3(axes * raised.asDiagonal() * axes.transpose());
}

}  // namespace sunder
