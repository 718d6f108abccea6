#include "fracture/stress/block_cholesky.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <Eigen/Cholesky>

#include "engine/base/state_checks.h"

namespace sunder::fracture {
namespace {

/// Adjacency matrix of a graph, one bit per pair of nodes.
class Graph {
 public:
  explicit Graph(std::size_t nodes) : words_((nodes + 63) / 64), bits_(nodes * words_) {}

  void join(std::uint32_t a, std::uint32_t b) {
    row(a)[b / 64] |= bit(b);
    row(b)[a / 64] |= bit(a);
  }
  std::uint32_t degree(std::uint32_t node) const {
    int sum = 0;
    for (std::size_t w = 0; w < words_; ++w) sum += std::popcount(row(node)[w]);
    return static_cast<std::uint32_t>(sum);
  }
  /// Calls `visit` for each neighbour of a node, ascending.
  template <class Visit>
  void for_each_beside(std::uint32_t node, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t rest = row(node)[w]; rest != 0; rest &= rest - 1)
        visit(static_cast<std::uint32_t>(64 * w) +
              static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
  }
  /// Eliminates a node: joins its neighbours with each other and removes it from their rows.
  void eliminate(std::uint32_t node) {
    for_each_beside(node, [&](std::uint32_t other) {
      for (std::size_t w = 0; w < words_; ++w) row(other)[w] |= row(node)[w];
      row(other)[node / 64] &= ~bit(node);
      row(other)[other / 64] &= ~bit(other);
    });
  }

 private:
  static std::uint64_t bit(std::uint32_t node) { return std::uint64_t{1} << (node % 64); }
  std::uint64_t* row(std::uint32_t node) { return bits_.data() + node * words_; }
  const std::uint64_t* row(std::uint32_t node) const { return bits_.data() + node * words_; }

  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

/// Computes y -= factor · x.
void subtract(const Six<double>& x, double factor, Six<double>& y) {
  y.linear -= splat<double>(factor) * x.linear;
  y.angular -= splat<double>(factor) * x.angular;
}

using Columns = std::array<Six<double>, 6>;

/// Returns the entry `row` of a column.
double entry(const Six<double>& column, std::size_t row) {
  return row < 3 ? column.linear[row] : column.angular[row - 3];
}

/// Computes c -= a bᵀ.
void subtract_product(const Columns& a, const Columns& b, Columns& c) {
  for (std::size_t j = 0; j < 6; ++j) {
    for (std::size_t k = 0; k < 6; ++k) subtract(a[k], entry(b[k], j), c[j]);
  }
}

/// Returns a x.
Six<double> times(const Columns& a, const Six<double>& x) {
  Six<double> product{};
  for (std::size_t k = 0; k < 6; ++k) subtract(a[k], -entry(x, k), product);
  return product;
}

/// Returns aᵀ x.
Six<double> transposed_times(const Columns& a, const Six<double>& x) {
  return {Simd4<double>{dot(a[0], x), dot(a[1], x), dot(a[2], x), 0},
          Simd4<double>{dot(a[3], x), dot(a[4], x), dot(a[5], x), 0}};
}

}  // namespace

BlockCholesky::BlockCholesky(std::size_t nodes, std::span<const Pair> pairs) : place_(nodes) {
  // Isolated nodes come first; the others are renumbered in their order.
  std::vector<std::uint32_t> number(nodes, 0), node_of;
  for (const auto& [a, b] : pairs) number[a] = number[b] = 1;
  for (std::uint32_t node = 0; node < nodes; ++node) {
    if (number[node] == 0) {
      order_.push_back(node);
    } else {
      number[node] = static_cast<std::uint32_t>(node_of.size());
      node_of.push_back(node);
    }
  }
  const std::size_t alone = order_.size();
  Graph graph(node_of.size());
  for (const auto& [a, b] : pairs) graph.join(number[a], number[b]);
  // Ranks are degree, then number, in one integer: one comparison each, contiguous in memory.
  constexpr std::int64_t kGone = std::numeric_limits<std::int64_t>::max();
  const auto rank_of = [&](std::uint32_t n) { return (std::int64_t{graph.degree(n)} << 32) | n; };
  std::vector<std::int64_t> ranks;
  for (std::uint32_t n = 0; n < node_of.size(); ++n) ranks.push_back(rank_of(n));
  while (order_.size() < nodes) {
    std::int64_t least = kGone;
    for (const std::int64_t rank : ranks) least = std::min(least, rank);
    const auto goes = static_cast<std::uint32_t>(least);
    ranks[goes] = kGone;
    order_.push_back(node_of[goes]);
    graph.eliminate(goes);
    graph.for_each_beside(goes, [&](std::uint32_t other) { ranks[other] = rank_of(other); });
  }
  for (std::uint32_t place = 0; place < nodes; ++place) place_[order_[place]] = place;
  for (std::uint32_t place = 0; place < nodes; ++place) {
    columns_.push_back(static_cast<std::uint32_t>(rows_.size()));
    rows_.push_back(place);
    if (place < alone) continue;
    graph.for_each_beside(number[order_[place]],
                          [&](std::uint32_t other) { rows_.push_back(place_[node_of[other]]); });
    std::sort(rows_.begin() + columns_.back(), rows_.end());
  }
  columns_.push_back(static_cast<std::uint32_t>(rows_.size()));
  blocks_.assign(rows_.size(), Columns{});
}

const char* BlockCholesky::wrong_field() const {
  const std::size_t count = nodes();
  if (!are_different_below(order_, count)) return "order_";
  if (place_.size() != count) return "place_";
  for (std::size_t place = 0; place < count; ++place)
    if (place_[order_[place]] != place) return "place_";
  if (columns_.size() != (columns_.empty() ? 0 : count + 1)) return "columns_";
  if (columns_.empty()) return count == 0 && rows_.empty() ? nullptr : "columns_";
  if (columns_[0] != 0 || columns_.back() != rows_.size()) return "columns_";
  if (blocks_.size() != rows_.size()) return "blocks_";
  for (std::size_t k = 0; k < count; ++k) {
    if (columns_[k] >= columns_[k + 1] || columns_[k + 1] > rows_.size()) return "columns_";
    if (rows_[columns_[k]] != k) return "rows_";
    for (std::size_t i = columns_[k] + 1; i < columns_[k + 1]; ++i)
      if (rows_[i] <= rows_[i - 1] || rows_[i] >= count) return "rows_";
  }
  return nullptr;
}

BlockCholesky::Columns BlockCholesky::columns_of(const Block& block) {
  Columns columns;
  for (int j = 0; j < 6; ++j)
    columns[static_cast<std::size_t>(j)] = {simd4<double>(block.col(j).head<3>()),
                                            simd4<double>(block.col(j).tail<3>())};
  return columns;
}

BlockCholesky::Block BlockCholesky::block_of(const Columns& columns) {
  Block block;
  for (int j = 0; j < 6; ++j) {
    const Six<double>& column = columns[static_cast<std::size_t>(j)];
    block.col(j) << vec3(column.linear), vec3(column.angular);
  }
  return block;
}

void BlockCholesky::add(std::uint32_t i, std::uint32_t j, const Block& block) {
  const bool below = place_[i] >= place_[j];
  const std::uint32_t row = place_[below ? i : j], column = place_[below ? j : i];
  const auto at =
      std::lower_bound(rows_.begin() + columns_[column], rows_.begin() + columns_[column + 1], row);
  Columns& here = blocks_[static_cast<std::size_t>(at - rows_.begin())];
  const Columns more = columns_of(below ? block : block.transpose());
  for (std::size_t k = 0; k < 6; ++k) subtract(more[k], -1, here[k]);
}

bool BlockCholesky::factorize() {
  for (std::size_t k = 0; k < nodes(); ++k) {
    const std::uint32_t begin = columns_[k], end = columns_[k + 1];
    const Eigen::LLT<Block> factor(block_of(blocks_[begin]));
    if (factor.info() != Eigen::Success) return false;
    const Columns inverse = columns_of(factor.matrixL().solve(Block::Identity()));
    blocks_[begin] = inverse;
    for (std::uint32_t a = begin + 1; a < end; ++a) {
      Columns product{};
      subtract_product(blocks_[a], inverse, product);
      for (std::size_t j = 0; j < 6; ++j) blocks_[a][j] = {-product[j].linear, -product[j].angular};
    }
    for (std::uint32_t b = begin + 1; b < end; ++b) {
      // The rows of column k below rows_[b] are also rows of that column.
      std::uint32_t at = columns_[rows_[b]];
      for (std::uint32_t a = b; a < end; ++a) {
        while (rows_[at] != rows_[a]) ++at;
        subtract_product(blocks_[a], blocks_[b], blocks_[at]);
      }
    }
  }
  return true;
}

void BlockCholesky::solve(std::span<Six<double>> x) const {
  for (std::size_t k = 0; k < nodes(); ++k) {
    Six<double>& here = x[order_[k]];
    here = times(blocks_[columns_[k]], here);
    for (std::uint32_t i = columns_[k] + 1; i < columns_[k + 1]; ++i) {
      const Six<double> product = times(blocks_[i], here);
      subtract(product, 1, x[order_[rows_[i]]]);
    }
  }
  for (std::size_t k = nodes(); k-- > 0;) {
    Six<double> here = x[order_[k]];
    for (std::uint32_t i = columns_[k] + 1; i < columns_[k + 1]; ++i)
      subtract(transposed_times(blocks_[i], x[order_[rows_[i]]]), 1, here);
    x[order_[k]] = transposed_times(blocks_[columns_[k]], here);
  }
}

std::uint64_t BlockCholesky::products() const {
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < nodes(); ++k) {
    const std::uint64_t blocks = columns_[k + 1] - columns_[k];
    sum += blocks * (blocks + 1) / 2;
  }
  return sum;
}

}  // namespace sunder::fracture
