#include "engine/geometry/inertia.h"

#include <Eigen/Eigenvalues>

namespace sunder {
namespace {

constexpr double kLeastMoment = 1e-4;  // of the largest

PrincipalMoments unbounded_moments(const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (inertia + inertia.transpose()));
  return {solver.eigenvectors(), solver.eigenvalues()};
}

Vec3 bounded(const Vec3& moments) { return moments.cwiseMax(kLeastMoment * moments.maxCoeff()); }

}  // namespace

PrincipalMoments principal_moments(const Mat3& inertia) {
  const auto [axes, moments] = unbounded_moments(inertia);
  return {axes, bounded(moments)};
}

Mat3 spinnable(const Mat3& inertia) {
  const auto [axes, moments] = unbounded_moments(inertia);
  const Vec3 enough = bounded(moments);
  return enough == moments ? inertia : Mat3(axes * enough.asDiagonal() * axes.transpose());
}

}  // namespace sunder
