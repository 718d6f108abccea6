#include "solver/rigid/joint/pinned_rows.h"

#include <algorithm>
#include <cmath>

namespace sunder::solver {
namespace {

constexpr int kPinRounds = 32;
constexpr double kAtBound = 1e-9;  // of it: rounding

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

void Envelope::factor() {
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t j = first[i]; j <= i; ++j) {
      double sum = at(i, j);
      for (std::uint32_t k = std::max(first[i], first[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = j < i ? sum / at(j, j) : std::sqrt(std::max(sum, 1e-12 * at(i, i)));
    }
  }
}

void Envelope::solve(std::span<double> x) const {
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t k = first[i]; k < i; ++k) x[i] -= at(i, k) * x[k];
    x[i] /= at(i, i);
  }
  for (std::uint32_t i = rows(); i-- > 0;) {
    x[i] /= at(i, i);
    for (std::uint32_t k = first[i]; k < i; ++k) x[k] -= at(i, k) * x[i];
  }
}

std::vector<double> Envelope::times(std::span<const double> x) const {
  std::vector<double> product(rows(), 0);
  for (std::uint32_t i = 0; i < rows(); ++i) {
    for (std::uint32_t k = first[i]; k < i; ++k) {
      product[i] += at(i, k) * x[k];
      product[k] += at(i, k) * x[i];
    }
    product[i] += at(i, i) * x[i];
  }
  return product;
}

/// Where it starts from: the impulses as they are, or none if these make energy.
void PinnedRows::start(const Envelope& response, std::span<const double> asked) {
  const std::size_t n = bounds.size();
  impulse_.resize(n), way_.resize(n);
  for (std::size_t i = 0; i < n; ++i) impulse_[i] = bounds[i].now;
  asked_ = response.times(impulse_);  // of impulses that start from none
  for (std::size_t i = 0; i < n; ++i) {
    asked_[i] += asked[i];
    impulse_[i] = bounds[i].clamp(impulse_[i]);
  }
  find_excess(response);
  if (dot(impulse_, excess_) > dot(impulse_, asked_)) {
    std::ranges::fill(impulse_, 0);
    find_excess(response);
  }
  for (std::size_t i = 0; i < n; ++i) {
    RowBounds& row = bounds[i];
    const bool high = impulse_[i] >= row.most - kAtBound * std::abs(row.most) && excess_[i] < 0;
    const bool low = impulse_[i] <= row.least + kAtBound * std::abs(row.least) && excess_[i] > 0;
    row.pin = high || row.least == row.most ? 1 : low ? -1 : 0;
    if (row.pin != 0) impulse_[i] = row.bound();
  }
}

void PinnedRows::find_excess(const Envelope& response) {
  excess_ = response.times(impulse_);
  for (std::size_t i = 0; i < bounds.size(); ++i) excess_[i] -= asked_[i];
}

/// Of the rows that are free, if they are others than last time.
void PinnedRows::factor(const Envelope& response) {
  const auto same = [](const RowBounds& row, std::uint8_t free) { return free == (row.pin == 0); };
  if (!stale_ && std::ranges::equal(bounds, factored_free_, same)) return;
  stale_ = false;
  factored_free_.clear();
  for (const RowBounds& row : bounds) factored_free_.push_back(row.pin == 0);
  factored_ = response;
  for (std::uint32_t i = 0; i < response.rows(); ++i) {
    for (std::uint32_t k = response.first[i]; k <= i; ++k)
      if (!factored_free_[i] || !factored_free_[k]) factored_.at(i, k) = i == k;
  }
  factored_.factor();
}

/// Goes the way of the free rows up to the first bound, and pins what meets it; whether none does.
bool PinnedRows::go() {
  const auto share_to_bound = [&](std::size_t i) {
    const RowBounds& row = bounds[i];
    const double to = impulse_[i] + way_[i];
    const bool over = to > row.most + kAtBound * std::abs(row.most) ||
                      to < row.least - kAtBound * std::abs(row.least);
    if (row.pin != 0 || !over) return 1.0;
    return std::max(0.0, ((way_[i] > 0 ? row.most : row.least) - impulse_[i]) / way_[i]);
  };
  double share = 1;
  for (std::size_t i = 0; i < bounds.size(); ++i) share = std::min(share, share_to_bound(i));
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    RowBounds& row = bounds[i];
    const bool meets = share < 1 && share_to_bound(i) <= share;
    if (meets) row.pin = way_[i] > 0 ? 1 : -1;
    impulse_[i] = meets ? row.bound() : impulse_[i] + share * way_[i];
  }
  return share == 1;
}

/// Whether any was pinned that would go back.
bool PinnedRows::let_go() {
  bool any = false;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    RowBounds& row = bounds[i];
    if (row.pin * excess_[i] <= 0 || row.least == row.most) continue;
    row.pin = 0;
    any = true;
  }
  return any;
}

void PinnedRows::solve(const Envelope& response, std::span<double> asked) {
  start(response, asked);
  for (int round = 0; round < kPinRounds; ++round) {
    factor(response);
    find_excess(response);
    for (std::size_t i = 0; i < way_.size(); ++i) way_[i] = bounds[i].pin != 0 ? 0 : -excess_[i];
    factored_.solve(way_);
    if (!go()) continue;
    find_excess(response);
    if (!let_go()) break;
  }
  for (std::size_t i = 0; i < bounds.size(); ++i) asked[i] = impulse_[i] - bounds[i].now;
}

}  // namespace sunder::solver
