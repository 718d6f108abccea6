// Direct solver for a spring system: Cholesky factorization of a sparse symmetric matrix of 6×6
// blocks, with nodes eliminated in order of least degree (Rose 1972).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// Factorization K = L Lᵀ of a symmetric positive definite K, zero until add() is called.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  BlockCholesky() = default;
  /// `pairs`: pairs of different nodes with a nonzero block, in any order; may have duplicates.
  BlockCholesky(std::size_t nodes, std::span<const Pair> pairs);

  std::size_t nodes() const { return order_.size(); }
  /// Adds to the block K_ij of one node or of one of the pairs, and its transpose to K_ji.
  void add(std::uint32_t i, std::uint32_t j, const Block& block);
  /// Replaces K by L; returns false, and destroys K, if K is not positive definite.
  bool factorize();
  /// Replaces x, by node, by K⁻¹ x.
  void solve(std::span<Six<double>> x) const;
  /// Returns the number of block products of a factorization.
  std::uint64_t products() const;

  static auto fields(auto& self) {
    return std::tie(self.order_, self.place_, self.blocks_, self.rows_, self.columns_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  using Columns = std::array<Six<double>, 6>;  ///< Columns of a block.

  static Columns columns_of(const Block& block);
  static Block block_of(const Columns& columns);

  /// Nodes in order of elimination, and the place of each node in that order.
  std::vector<std::uint32_t> order_, place_;
  /// Blocks by columns in order of elimination, each column from the diagonal down; after
  /// factorize() those of L, with inverse diagonal blocks.
  std::vector<Columns> blocks_;
  std::vector<std::uint32_t> rows_;  ///< Row of each block.
  /// Index of the first block of each column, and the number of blocks.
  std::vector<std::uint32_t> columns_;
};

}  // namespace sunder::fracture
