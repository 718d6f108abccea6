#include "solver/impact/impulse_distribution.h"

#include <algorithm>

#include <Eigen/Dense>

namespace sunder::solver {

void distribute_evenly(std::span<ContactPointImpulse> points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  double reach_m = 0;
  for (const ContactPointImpulse& point : points) reach_m = std::max(reach_m, point.arm_W.norm());
  if (n < 2 || !(reach_m > 0)) return;
  Eigen::Matrix<double, 6, Eigen::Dynamic> G(6, n);  // force and moment of each unit impulse
  Eigen::VectorXd impulses_Ns(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactPointImpulse& point = points[static_cast<std::size_t>(i)];
    impulses_Ns[i] = point.impulse_Ns;
    G.col(i) << point.direction_W, point.arm_W.cross(point.direction_W) / reach_m;
  }
  const Eigen::Matrix<double, 6, 6> square = G * G.transpose();
  const Eigen::Matrix<double, 6, 1> sum = G * impulses_Ns;
  const Eigen::VectorXd even = G.transpose() * square.completeOrthogonalDecomposition().solve(sum);
  if (!even.allFinite() || even.minCoeff() < 0) return;
  for (Eigen::Index i = 0; i < n; ++i) points[static_cast<std::size_t>(i)].impulse_Ns = even[i];
}

}  // namespace sunder::solver
