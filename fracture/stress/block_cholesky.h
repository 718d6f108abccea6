// The direct solver of nodes on springs: the Cholesky factor of a matrix of 6×6 blocks, most of
// which are zero, and stay so if nodes go in order of least degree (Rose 1972).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// K = L Lᵀ of a symmetric positive definite K; zero until added to.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  BlockCholesky() = default;
  /// `pairs`: of different nodes whose block is not zero, in any order, as often as they like.
  BlockCholesky(std::size_t nodes, std::span<const Pair> pairs);

  std::size_t nodes() const { return order_.size(); }
  /// K_ij, of a node with itself or one of the pairs; K_ji follows.
  void add(std::uint32_t i, std::uint32_t j, const Block& block);
  /// What was added becomes L; false if K is not positive definite, and then nothing is left of it.
  bool factorize();
  /// x, by node, becomes K⁻¹ x.
  void solve(std::span<Six<double>> x) const;
  /// Of blocks, to factorize it.
  std::uint64_t products() const;

 private:
  using Columns = std::array<Six<double>, 6>;  ///< Of a block.

  static Columns columns_of(const Block& block);
  static Block block_of(const Columns& columns);

  std::vector<std::uint32_t> order_, place_;  ///< Nodes as they are eliminated; when, per node.
  /// By columns in that order, each from its diagonal down; of L, with the diagonal's inverse.
  std::vector<Columns> blocks_;
  std::vector<std::uint32_t> rows_;     ///< Per block.
  std::vector<std::uint32_t> columns_;  ///< Where each begins; and the end.
};

}  // namespace sunder::fracture
