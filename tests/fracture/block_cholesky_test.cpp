// Tests of the sparse block Cholesky factorization against dense matrices.
#include "fracture/stress/block_cholesky.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::fracture::block_cholesky_test {
namespace {

using Block = BlockCholesky::Block;
using Nodal = std::vector<Six<double>>;

/// Returns the pairs of neighbours of a plane lattice of nodes with `width` nodes per row.
std::vector<BlockCholesky::Pair> lattice(std::uint32_t nodes, std::uint32_t width) {
  std::vector<BlockCholesky::Pair> pairs;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (i % width + 1 < width && i + 1 < nodes) pairs.emplace_back(i + 1, i);
    if (i + width < nodes) pairs.emplace_back(i, i + width);
  }
  return pairs;
}

Block random_block(Random& random) {
  Block block;
  for (double& x : block.reshaped()) x = random.uniform(-1, 1);
  return block;
}

TEST(BlockCholesky, MatchesADenseSolve) {
  for (const std::uint32_t nodes : {1u, 2u, 7u, 30u, 70u}) {
    Random random(nodes);
    const auto pairs = lattice(nodes, 5);
    BlockCholesky sparse(nodes, pairs);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6 * nodes, 6 * nodes);
    for (std::uint32_t i = 0; i < nodes; ++i) {
      const Block own = 40 * Block::Identity();
      sparse.add(i, i, own);
      dense.block<6, 6>(6 * i, 6 * i) += own;
    }
    for (const auto& [a, b] : pairs) {
      const Block both = random_block(random);
      sparse.add(a, b, both);
      dense.block<6, 6>(6 * a, 6 * b) += both;
      dense.block<6, 6>(6 * b, 6 * a) += both.transpose();
    }
    ASSERT_TRUE(sparse.factorize());
    Nodal x(nodes);
    Eigen::VectorXd f(6 * nodes);
    for (double& value : f) value = random.uniform(-1, 1);
    for (std::uint32_t i = 0; i < nodes; ++i)
      x[i] = {simd4<double>(f.segment<3>(6 * i)), simd4<double>(f.segment<3>(6 * i + 3))};
    sparse.solve(x);
    const Eigen::VectorXd expected = dense.llt().solve(f);
    for (std::uint32_t i = 0; i < nodes; ++i) {
      EXPECT_LT((vec3(x[i].linear) - expected.segment<3>(6 * i)).norm(), 1e-13) << i;
      EXPECT_LT((vec3(x[i].angular) - expected.segment<3>(6 * i + 3)).norm(), 1e-13) << i;
    }
  }
}

TEST(BlockCholesky, ReportsAMatrixThatIsNotPositiveDefinite) {
  const std::vector<BlockCholesky::Pair> pairs = {{0, 1}};
  BlockCholesky matrix(2, pairs);
  matrix.add(0, 0, Block::Identity());
  matrix.add(1, 1, Block::Identity());
  matrix.add(0, 1, -1.01 * Block::Identity());
  EXPECT_FALSE(matrix.factorize());
}

TEST(BlockCholesky, UnconnectedNodesCostOneProductEach) {
  constexpr std::uint32_t kNodes = 20000;  // A dense matrix would have 115 GB.
  BlockCholesky matrix(kNodes, {});
  for (std::uint32_t i = 0; i < kNodes; ++i) matrix.add(i, i, 2 * Block::Identity());
  ASSERT_TRUE(matrix.factorize());
  EXPECT_EQ(matrix.products(), kNodes);
  const Simd4<double> ones = simd4<double>(Vec3::Ones());
  Nodal x(kNodes, {ones, ones});
  matrix.solve(x);
  for (const Six<double>& node : x) {
    EXPECT_LT((vec3(node.linear) - Vec3::Constant(0.5)).norm(), 1e-15);
    EXPECT_LT((vec3(node.angular) - Vec3::Constant(0.5)).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace sunder::fracture::block_cholesky_test
