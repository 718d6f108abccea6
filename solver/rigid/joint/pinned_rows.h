// Linear equations for impulses some of which are bounded: a band, rows of which are pinned.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace sunder::solver {

/// A symmetric positive matrix whose row i begins at column first[i]: an envelope, which factoring
/// into L·Lᵀ does not leave.
struct Envelope {
  std::vector<std::uint32_t> first;  ///< Column of each row's first entry.
  std::vector<std::uint32_t> start;  ///< Where a row's entries begin; one more than there are rows.
  std::vector<double> entries;

  std::uint32_t rows() const { return static_cast<std::uint32_t>(first.size()); }
  double& at(std::uint32_t row, std::uint32_t column) {
    return entries[start[row] + column - first[row]];
  }
  double at(std::uint32_t row, std::uint32_t column) const {
    return entries[start[row] + column - first[row]];
  }
  /// Entries of a row, from a column on, and to before another.
  std::span<const double> row(std::uint32_t row, std::uint32_t from, std::uint32_t to) const {
    return std::span(entries).subspan(start[row] + from - first[row], to - from);
  }
  /// Cholesky, in place, of the rows from one on: those before it are factored. Pivots must be
  /// positive.
  void factor(std::uint32_t from = 0);
  /// Solves for the right side, in place.
  void solve(std::span<double> right) const;
  /// The product, before it is factored.
  std::vector<double> times(std::span<const double> x) const;
};

/// An impulse, between which it may be, and whether it is held at one of both.
struct RowBounds {
  double now = 0;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::int8_t pin = 0;  ///< -1: at the least; 1: at the most, or both are one and it stays there.

  double bound() const { return pin < 0 ? least : most; }
  double clamp(double impulse) const { return std::clamp(impulse, least, most); }
};

/// Changes x of impulses so that response·x is what is asked, but where a bound keeps an impulse
/// from it: the least of x·response·x/2 - asked·x within the bounds. By a primal active set: every
/// round lowers that, so that what it ends with, however early, makes no energy.
class PinnedRows {
 public:
  std::vector<RowBounds> bounds;

  /// The response is another: what was factored does not count any more.
  void forget() { stale_ = true; }
  /// What is asked becomes the change. Bounds include none; rows are pinned or free after it.
  void solve(const Envelope& response, std::span<double> asked);

 private:
  void start(const Envelope& response, std::span<const double> asked);
  void find_excess(const Envelope& response);
  void factor(const Envelope& response);
  bool go();
  bool let_go();

  Envelope factored_;  ///< The response of rows that are free.
  std::vector<std::uint8_t> factored_free_;
  std::vector<double> impulse_, way_;
  std::vector<double> asked_;   ///< As if impulses were none now.
  std::vector<double> excess_;  ///< Of the response over that.
  bool stale_ = true;
};

}  // namespace sunder::solver
