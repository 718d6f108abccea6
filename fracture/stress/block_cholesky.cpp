#include "fracture/stress/block_cholesky.h"

#include <algorithm>
#include <iterator>

#include <Eigen/Cholesky>

namespace sunder::fracture {
namespace {

using Nodes = std::vector<std::uint32_t>;

std::vector<Nodes> neighbours(std::size_t nodes, std::span<const BlockCholesky::Pair> pairs) {
  std::vector<Nodes> beside(nodes);
  for (const auto& [a, b] : pairs) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  for (Nodes& list : beside) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return beside;
}

}  // namespace

BlockCholesky::BlockCholesky(std::size_t nodes, std::span<const Pair> pairs) : place_(nodes) {
  std::vector<Nodes> beside = neighbours(nodes, pairs);
  Nodes left;
  for (std::uint32_t node = 0; node < nodes; ++node)
    (beside[node].empty() ? order_ : left).push_back(node);
  // What goes makes neighbours of its neighbours.
  Nodes merged;
  while (!left.empty()) {
    const auto least = std::ranges::min_element(
        left, {}, [&](std::uint32_t node) { return std::pair(beside[node].size(), node); });
    const std::uint32_t node = *least;
    *least = left.back();
    left.pop_back();
    order_.push_back(node);
    for (const std::uint32_t other : beside[node]) {
      merged.clear();
      std::ranges::set_union(beside[other], beside[node], std::back_inserter(merged));
      std::erase_if(merged, [&](std::uint32_t n) { return n == node || n == other; });
      beside[other] = merged;
    }
  }
  for (std::uint32_t place = 0; place < nodes; ++place) place_[order_[place]] = place;
  for (const std::uint32_t node : order_) {
    columns_.push_back(static_cast<std::uint32_t>(rows_.size()));
    rows_.push_back(place_[node]);
    for (const std::uint32_t other : beside[node]) rows_.push_back(place_[other]);
    std::sort(rows_.begin() + columns_.back(), rows_.end());
  }
  columns_.push_back(static_cast<std::uint32_t>(rows_.size()));
  blocks_.assign(rows_.size(), Block::Zero());
}

void BlockCholesky::add(std::uint32_t i, std::uint32_t j, const Block& block) {
  const bool below = place_[i] >= place_[j];
  const std::uint32_t row = place_[below ? i : j], column = place_[below ? j : i];
  const auto at = std::lower_bound(rows_.begin() + columns_[column],
                                   rows_.begin() + columns_[column + 1], row);
  Block& here = blocks_[static_cast<std::size_t>(at - rows_.begin())];
  if (below) {
    here += block;
  } else {
    here += block.transpose();
  }
}

bool BlockCholesky::factorize() {
  for (std::size_t k = 0; k < nodes(); ++k) {
    const std::uint32_t begin = columns_[k], end = columns_[k + 1];
    const Eigen::LLT<Block> factor(blocks_[begin]);
    if (factor.info() != Eigen::Success) return false;
    Block& inverse = blocks_[begin];
    inverse.setIdentity();
    factor.matrixL().solveInPlace(inverse);
    for (std::uint32_t a = begin + 1; a < end; ++a) blocks_[a] *= inverse.transpose();
    for (std::uint32_t b = begin + 1; b < end; ++b) {
      std::uint32_t at = columns_[rows_[b]];  // what is below k's row is in that row's column
      for (std::uint32_t a = b; a < end; ++a) {
        while (rows_[at] != rows_[a]) ++at;
        blocks_[at].noalias() -= blocks_[a] * blocks_[b].transpose();
      }
    }
  }
  return true;
}

void BlockCholesky::solve(std::span<Row> x) const {
  for (std::size_t k = 0; k < nodes(); ++k) {
    Row& here = x[order_[k]];
    here = blocks_[columns_[k]] * here;
    for (std::uint32_t i = columns_[k] + 1; i < columns_[k + 1]; ++i)
      x[order_[rows_[i]]].noalias() -= blocks_[i] * here;
  }
  for (std::size_t k = nodes(); k-- > 0;) {
    Row here = x[order_[k]];
    for (std::uint32_t i = columns_[k] + 1; i < columns_[k + 1]; ++i)
      here.noalias() -= blocks_[i].transpose() * x[order_[rows_[i]]];
    x[order_[k]].noalias() = blocks_[columns_[k]].transpose() * here;
  }
}

}  // namespace sunder::fracture
