#include "engine/world/complementarity.h"

#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>

namespace sunder {
namespace {

constexpr double kTolerance = 1e-9;
constexpr int kMostPivots = 200;
constexpr int kPatience = 3;  // block exchanges without progress before single ones

/// x with A·x = b where `free`, 0 elsewhere.
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

}  // namespace

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const auto n = static_cast<std::size_t>(b.size());
  const double greatest = b.cwiseMax(0).size() ? b.maxCoeff() : 0;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  if (greatest <= 0) return x;
  std::vector<std::uint8_t> free(n, 0);
  std::size_t fewest = n + 1;
  int patience = kPatience;
  for (int pivot = 0; pivot < kMostPivots; ++pivot) {
    const Eigen::VectorXd missing = b - A * x;
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (free[i] ? x[row] < 0 : missing[row] > kTolerance * greatest) wrong.push_back(i);
    }
    if (wrong.empty()) break;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = kPatience;
    } else if (patience > 0) {
      --patience;
    } else {
      wrong.erase(wrong.begin(), wrong.end() - 1);
    }
    for (const std::size_t i : wrong) free[i] ^= 1;
    x = solve_free(A, b, free);
  }
  return x.cwiseMax(0);
}

}  // namespace sunder
