// What contacts do to each other: none pulls, and none that parts pushes.
#pragma once

#include <Eigen/Core>

namespace sunder {

/// x ≥ 0 with A·x ≥ b, and equality wherever x > 0, for a symmetric positive definite A; by block
/// principal pivoting (Júdice and Pires 1994), to about 1e-9 of the greatest b. Costs a few
/// factorizations of the part of A where x > 0. Where rounding leaves pivoting no end, sweeps do
/// what they can: ½xᵀAx − xᵀb, the energy that x adds, is never more than 0.
Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace sunder
