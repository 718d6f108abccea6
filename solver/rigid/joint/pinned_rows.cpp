#include "solver/rigid/joint/pinned_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sunder::solver {
namespace {

constexpr int kMaxPinRounds = 32;
constexpr double kBoundRounding = 1e-9;  // relative, for rounding

/// Dot product in eight partial sums, which run in parallel and give the same bits on any
/// processor.
double dot(std::span<const double> a, std::span<const double> b) {
  std::array<double, 8> sums{};
  const std::size_t whole = a.size() / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sums[k] += a[i + k] * b[i + k];
  for (std::size_t i = whole; i < a.size(); ++i) sums[i - whole] += a[i] * b[i];
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

}  // namespace

void Envelope::factor(std::uint32_t from) {
  for (std::uint32_t i = from; i < rows(); ++i) {
    for (std::uint32_t j = first[i]; j <= i; ++j) {
      const std::uint32_t both = std::min(j, std::max(first[i], first[j]));
      const double sum = at(i, j) - dot(row(i, both, j), row(j, both, j));
      at(i, j) = j < i ? sum / at(j, j) : std::sqrt(std::max(sum, 1e-12 * at(i, i)));
    }
  }
}

void Envelope::solve(std::span<double> x) const {
  for (std::uint32_t i = 0; i < rows(); ++i) {
    x[i] = (x[i] - dot(row(i, first[i], i), x.subspan(first[i], i - first[i]))) / at(i, i);
  }
  for (std::uint32_t i = rows(); i-- > 0;) {
    x[i] /= at(i, i);
    for (std::uint32_t k = first[i]; k < i; ++k) x[k] -= at(i, k) * x[i];
  }
}

std::vector<double> Envelope::times(std::span<const double> x) const {
  std::vector<double> product(rows(), 0);
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t k = first[i]; k < i; ++k) product[k] += at(i, k) * x[i];
    product[i] += dot(row(i, first[i], i + 1), x.subspan(first[i], i + 1 - first[i]));
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
  for (std::uint32_t i = from; i < response.rows(); ++i) {
    for (std::uint32_t k = response.first[i]; k <= i; ++k)
      if (!factored_free_[i] || !factored_free_[k]) factored_.at(i, k) = i == k;
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
