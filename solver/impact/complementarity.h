// Linear complementarity problem of frictionless contacts: no contact pulls, and contacts that
// separate have no impulse.
#pragma once

#include <Eigen/Core>

namespace sunder::solver {

/// Returns x ≥ 0 with A·x ≥ b, and equality wherever x > 0, for a symmetric positive definite A; by
/// block principal pivoting (Júdice and Pires 1994), to about 1e-9 of the greatest b. Costs a few
/// factorizations of the part of A where x > 0. Where rounding errors keep pivoting from ending,
/// sweeps improve its best result. The energy that x adds, ½xᵀAx − xᵀb, is never more than 0.
Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace sunder::solver
