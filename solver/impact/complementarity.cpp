#include "solver/impact/complementarity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>

#include "solver/impact/tuning.h"

namespace sunder::solver {
namespace {

// Rounding error of the solution, as a fraction of the largest entry of b.
constexpr double kPivotTolerance = 1e-9;

/// Returns x with A·x = b in the rows that are `free`, and x = 0 in the others.
Eigen::VectorXd solve_free(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                           const std::vector<std::uint8_t>& free) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    if (free[static_cast<std::size_t>(i)]) rows.push_back(i);
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  if (!rows.empty()) x(rows) = A(rows, rows).llt().solve(b(rows)).eval();
  return x;
}

/// Returns the change of energy by x: at most 0 for the solution.
double energy(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  return x.dot(0.5 * (A * x) - b);
}

/// Returns the solution; if rounding errors keep pivoting from ending (`solved` is false), the
/// iterate of least energy.
Eigen::VectorXd pivot(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, bool& solved) {
  const auto n = static_cast<std::size_t>(b.size());
  const double enough = kPivotTolerance * b.maxCoeff();
  std::vector<Eigen::VectorXd> tried{Eigen::VectorXd::Zero(b.size())};
  std::vector<std::uint8_t> free(n, 0);
  std::size_t fewest = n + 1;
  int patience = kPivotPatience;
  for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
    const Eigen::VectorXd& x = tried.back();
    const Eigen::VectorXd missing = b - A * x;
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (free[i] ? x[row] < 0 : missing[row] > enough) wrong.push_back(i);
    }
    solved = wrong.empty();
    if (solved) break;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = kPivotPatience;
    } else if (patience > 0) {
      --patience;
    } else {
      wrong.erase(wrong.begin(), wrong.end() - 1);
    }
    for (const std::size_t i : wrong) free[i] ^= 1;
    tried.push_back(solve_free(A, b, free));
  }
  solved = solved && energy(A, b, tried.back()) <= 0;
  if (solved) return tried.back();
  for (Eigen::VectorXd& x : tried) x = x.cwiseMax(0).eval();
  return *std::ranges::min_element(tried, {},
                                   [&](const Eigen::VectorXd& x) { return energy(A, b, x); });
}

/// Improves x by projected Gauss-Seidel, in which every change of x reduces the energy.
void sweep(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const double enough = kPivotTolerance * b.maxCoeff();
  for (int i = 0; i < kMaxFallbackSweeps; ++i) {
    double most = 0;
    for (Eigen::Index row = 0; row < b.size(); ++row) {
      const double was = x[row];
      x[row] = std::max(0.0, was + (b[row] - A.row(row).dot(x)) / A(row, row));
      most = std::max(most, std::abs(x[row] - was));
    }
    if (most <= enough) return;
  }
}

}  // namespace

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  if (b.size() == 0 || b.maxCoeff() <= 0) return Eigen::VectorXd::Zero(b.size());
  // Scaled to a unit diagonal: masses in a cluster may differ by a factor of a million.
  const Eigen::VectorXd unit = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd A_unit = unit.asDiagonal() * A * unit.asDiagonal();
  const Eigen::VectorXd b_unit = unit.cwiseProduct(b);
  bool solved = false;
  Eigen::VectorXd x = pivot(A_unit, b_unit, solved);
  if (!solved) sweep(A_unit, b_unit, x);
  return unit.cwiseProduct(x);
}

}  // namespace sunder::solver
