#include "solver/rigid/joint/pinned_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sunder::solver {
namespace {

constexpr int kMaxPinRounds = 32;
constexpr double kBoundRounding = 1e-9;  // relative, for rounding

typedef double Doubles __attribute__((vector_size(32), aligned(8), may_alias));
typedef std::int64_t Bits __attribute__((vector_size(32), aligned(8), may_alias));

/// All bits for the first elements and none for the others, from index 8 - n on for n of eight.
constexpr std::array<std::int64_t, 16> kFirst = {-1, -1, -1, -1, -1, -1, -1, -1};

/// Returns products of four elements.
inline Doubles products(const double* a, const double* b) {
  return *reinterpret_cast<const Doubles*>(a) * *reinterpret_cast<const Doubles*>(b);
}

inline Doubles masked(const Doubles& a, const std::int64_t* bits) {
  return reinterpret_cast<Doubles>(reinterpret_cast<Bits>(a) &
                                   *reinterpret_cast<const Bits*>(bits));
}

inline double sum_of(const Doubles& low, const Doubles& high) {
  const Doubles sums = low + high;
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

/// Dot product in eight partial sums, which run in parallel and give the same bits on any
/// processor. Up to seven elements after the last are read, and not used.
inline double padded_dot(const double* a, const double* b, std::size_t count) {
  Doubles low{}, high{};
  const std::size_t whole = count / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8) {
    low += products(a + i, b + i);
    high += products(a + i + 4, b + i + 4);
  }
  if (const std::size_t rest = count - whole; rest > 0) {
    low += masked(products(a + whole, b + whole), &kFirst[8 - rest]);
    high += masked(products(a + whole + 4, b + whole + 4), &kFirst[12 - rest]);
  }
  return sum_of(low, high);
}

/// As padded_dot(), without reading beyond the end.
double dot(std::span<const double> a, std::span<const double> b) {
  Doubles low{}, high{};
  const std::size_t whole = a.size() / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8) {
    low += products(&a[i], &b[i]);
    high += products(&a[i + 4], &b[i + 4]);
  }
  for (std::size_t i = whole; i < a.size(); ++i) {
    const std::size_t k = i - whole;
    (k < 4 ? low : high)[k % 4] += a[i] * b[i];
  }
  return sum_of(low, high);
}

}  // namespace

void Envelope::factor(std::uint32_t from) {
  std::vector<std::uint32_t> end(rows(), 0);  // row after the last one that has a column
  for (std::uint32_t i = 0; i < rows(); ++i) end[first[i]] = i + 1;
  for (std::uint32_t j = 1; j < rows(); ++j) end[j] = std::max(end[j], end[j - 1]);
  // Column by column: the products of one column do not wait for each other.
  for (std::uint32_t j = 0; j < rows(); ++j) {
    const double* row_j = &entries[start[j]];
    if (j >= from) {
      const double sum = at(j, j) - padded_dot(row_j, row_j, j - first[j]);
      at(j, j) = std::sqrt(std::max(sum, 1e-12 * at(j, j)));
    }
    const double diagonal = at(j, j);
    for (std::uint32_t i = std::max(from, j + 1); i < end[j]; ++i) {
      if (first[i] > j) continue;
      const std::uint32_t both = std::max(first[i], first[j]);
      double* row_i = &entries[start[i]];
      double& entry = row_i[j - first[i]];
      entry = (entry - padded_dot(row_i + (both - first[i]), row_j + (both - first[j]), j - both)) /
              diagonal;
    }
  }
}

void Envelope::solve(std::span<double> x) const {
  for (std::uint32_t i = 0; i < rows(); ++i) {
    x[i] = (x[i] - dot(row(i, first[i], i), x.subspan(first[i], i - first[i]))) / at(i, i);
  }
  for (std::uint32_t i = rows(); i-- > 0;) {
    const double* row_i = &entries[start[i]];
    double* above = &x[first[i]];
    const std::uint32_t count = i - first[i];
    const double at_i = x[i] / row_i[count];
    x[i] = at_i;
    for (std::uint32_t k = 0; k < count; ++k) above[k] -= row_i[k] * at_i;
  }
}

std::vector<double> Envelope::times(std::span<const double> x) const {
  std::vector<double> product(rows(), 0);
  for (std::uint32_t i = 0; i < rows(); ++i) {
    const double* row_i = &entries[start[i]];
    double* above = &product[first[i]];
    const std::uint32_t count = i - first[i];
    for (std::uint32_t k = 0; k < count; ++k) above[k] += row_i[k] * x[i];
    product[i] += dot(row(i, first[i], i + 1), x.subspan(first[i], count + 1));
  }
  return product;
}

/// Sets the initial impulses: the current ones, or zero if these make energy.
void PinnedRows::start(const Envelope& response, std::span<const double> target) {
  const std::size_t n = bounds.size();
  impulse_.resize(n), direction_.resize(n);
  for (std::size_t i = 0; i < n; ++i) impulse_[i] = bounds[i].now;
  target_ = response.times(impulse_);  // for impulses that start at zero
  for (std::size_t i = 0; i < n; ++i) {
    target_[i] += target[i];
    impulse_[i] = bounds[i].clamp(impulse_[i]);
  }
  find_excess(response);
  if (dot(impulse_, excess_) > dot(impulse_, target_)) {
    std::ranges::fill(impulse_, 0);
    find_excess(response);
  }
  for (std::size_t i = 0; i < n; ++i) {
    RowBounds& row = bounds[i];
    const bool high =
        impulse_[i] >= row.most - kBoundRounding * std::abs(row.most) && excess_[i] < 0;
    const bool low =
        impulse_[i] <= row.least + kBoundRounding * std::abs(row.least) && excess_[i] > 0;
    row.pin = high || row.least == row.most ? 1 : low ? -1 : 0;
    if (row.pin != 0) impulse_[i] = row.bound();
  }
}

void PinnedRows::find_excess(const Envelope& response) {
  excess_ = response.times(impulse_);
  for (std::size_t i = 0; i < bounds.size(); ++i) excess_[i] -= target_[i];
}

/// Factors the free rows from the first one on that changed, as a row depends only on those before.
void PinnedRows::factor(const Envelope& response) {
  std::uint32_t from = 0;
  if (!std::exchange(stale_, false)) {
    while (from < response.rows() && (bounds[from].pin == 0) == (factored_free_[from] != 0)) ++from;
    if (from == response.rows()) return;
    std::copy(response.entries.begin() + response.start[from], response.entries.end(),
              factored_.entries.begin() + response.start[from]);
  } else {
    factored_ = response;
  }
  factored_free_.clear();
  for (const RowBounds& row : bounds) factored_free_.push_back(row.pin == 0);
  for (std::uint32_t i = 0; i < response.rows(); ++i) {
    if (factored_free_[i]) continue;
    for (std::uint32_t k = std::max(from, i + 1); k < response.rows(); ++k)
      if (response.first[k] <= i) factored_.at(k, i) = 0;
    if (i < from) continue;
    for (std::uint32_t k = response.first[i]; k <= i; ++k) factored_.at(i, k) = i == k;
  }
  factored_.factor(from);
}

/// Steps along the direction of the free rows up to the first bound, and pins the rows that reach
/// it. Returns true if none does.
bool PinnedRows::step_to_bound() {
  const auto share_to_bound = [&](std::size_t i) {
    const RowBounds& row = bounds[i];
    const double to = impulse_[i] + direction_[i];
    const bool over = to > row.most + kBoundRounding * std::abs(row.most) ||
                      to < row.least - kBoundRounding * std::abs(row.least);
    if (row.pin != 0 || !over) return 1.0;
    return std::max(0.0,
                    ((direction_[i] > 0 ? row.most : row.least) - impulse_[i]) / direction_[i]);
  };
  double share = 1;
  for (std::size_t i = 0; i < bounds.size(); ++i) share = std::min(share, share_to_bound(i));
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    RowBounds& row = bounds[i];
    const bool meets = share < 1 && share_to_bound(i) <= share;
    if (meets) row.pin = direction_[i] > 0 ? 1 : -1;
    impulse_[i] = meets ? row.bound() : impulse_[i] + share * direction_[i];
  }
  return share == 1;
}

/// Frees the pinned rows that would move off their bound; returns true if there are any.
bool PinnedRows::free_rows() {
  bool any = false;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    RowBounds& row = bounds[i];
    if (row.pin * excess_[i] <= 0 || row.least == row.most) continue;
    row.pin = 0;
    any = true;
  }
  return any;
}

void PinnedRows::solve(const Envelope& response, std::span<double> target) {
  start(response, target);
  for (int round = 0; round < kMaxPinRounds; ++round) {
    factor(response);
    find_excess(response);
    for (std::size_t i = 0; i < direction_.size(); ++i)
      direction_[i] = bounds[i].pin != 0 ? 0 : -excess_[i];
    factored_.solve(direction_);
    if (!step_to_bound()) continue;
    find_excess(response);
    if (!free_rows()) break;
  }
  for (std::size_t i = 0; i < bounds.size(); ++i) target[i] = impulse_[i] - bounds[i].now;
}

}  // namespace sunder::solver
