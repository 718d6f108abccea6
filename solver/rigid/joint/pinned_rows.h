// Systems of linear equations for impulses with bounds: a band whose rows may be pinned to a bound.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace sunder::solver {

/// A symmetric positive definite matrix in envelope storage: row i begins at column first[i], and
/// the factor L of L·Lᵀ has the same envelope.
struct Envelope {
  static constexpr std::size_t kPadding = 8;  ///< Unused entries at the end, for wide reads.

  std::vector<std::uint32_t> first;  ///< Column of each row's first entry.
  /// Index of each row's first entry; one more than there are rows.
  std::vector<std::uint32_t> start;
  std::vector<double> entries;  ///< Those of all rows, and the padding.

  std::uint32_t rows() const { return static_cast<std::uint32_t>(first.size()); }
  double& at(std::uint32_t row, std::uint32_t column) {
    return entries[start[row] + column - first[row]];
  }
  double at(std::uint32_t row, std::uint32_t column) const {
    return entries[start[row] + column - first[row]];
  }
  /// Returns the entries of a row in columns [from, to).
  std::span<const double> row(std::uint32_t row, std::uint32_t from, std::uint32_t to) const {
    return std::span(entries).subspan(start[row] + from - first[row], to - from);
  }
  /// Cholesky factorization in place, of the rows from `from` on; those before must be factored.
  /// Pivots must be positive.
  void factor(std::uint32_t from = 0);
  /// Solves for the right side, in place.
  void solve(std::span<double> right) const;
  /// Returns the product with x; valid before factor().
  std::vector<double> times(std::span<const double> x) const;
};

/// An impulse and its bounds, and the bound that it is pinned to.
struct RowBounds {
  double now = 0;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::int8_t pin = 0;  ///< -1: pinned to the least; 1: to the most, or to both if they are equal.

  double bound() const { return pin < 0 ? least : most; }
  double clamp(double impulse) const { return std::clamp(impulse, least, most); }
};

/// Finds the changes x of impulses with response·x = target, as far as bounds allow: the minimum of
/// x·response·x/2 - target·x within the bounds. By a primal active-set method: each round lowers
/// that function, so the result makes no energy after any number of rounds.
class PinnedRows {
 public:
  std::vector<RowBounds> bounds;

  /// Must be called when the response has changed: discards the factorization.
  void invalidate() { stale_ = true; }
  /// Replaces the target by the change. The bounds must include zero; rows are pinned or free
  /// afterwards.
  void solve(const Envelope& response, std::span<double> target);

 private:
  void start(const Envelope& response, std::span<const double> target);
  void find_excess(const Envelope& response);
  void factor(const Envelope& response);
  bool step_to_bound();
  bool free_rows();

  Envelope factored_;  ///< Factored response of the free rows.
  std::vector<std::uint8_t> factored_free_;
  std::vector<double> impulse_, direction_;
  std::vector<double> target_;  ///< Target for impulses that start at zero.
  std::vector<double> excess_;  ///< Excess of the response over the target.
  bool stale_ = true;
};

}  // namespace sunder::solver
