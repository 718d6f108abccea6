#include "scenes/trade/two_samples.h"

#include <algorithm>
#include <numeric>

#include "engine/base/check.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kPermutations = 1000;  // with that of the groups as they are
constexpr double kTie = 1e-9;  // differences that are equal but for rounding, in mean distances

/// Distances of all pairs in all matrices, those of one pair one after another.
class Interleaved {
 public:
  explicit Interleaved(std::span<const DistanceMatrix> matrices)
      : runs_(matrices[0].runs()),
        count_(matrices.size()),
        values_(runs_ * runs_ * count_),
        sums_(count_) {
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t i = 0; i < runs_; ++i) {
        for (std::size_t j = 0; j < runs_; ++j) {
          values_[(i * runs_ + j) * count_ + k] = matrices[k](i, j);
          if (j < i) sums_[k] += matrices[k](i, j);
        }
      }
    }
  }

  std::size_t runs() const { return runs_; }
  /// Returns the mean distance in a matrix.
  double mean(std::size_t k) const { return sums_[k] / pairs_of(runs_); }

  /// Writes the differences between the first `count` of these runs and the others.
  void differences(std::span<const std::size_t> order, std::size_t count, std::span<double> found) {
    sum_within(order.first(count), a_);
    sum_within(order.subspan(count), b_);
    const double in_a = pairs_of(count), in_b = pairs_of(runs_ - count);
    const double between = pairs_of(runs_) - in_a - in_b;
    for (std::size_t k = 0; k < count_; ++k)
      found[k] = (sums_[k] - a_[k] - b_[k]) / between - (a_[k] / in_a + b_[k] / in_b) / 2;
  }

 private:
  static double pairs_of(std::size_t runs) { return static_cast<double>(runs * (runs - 1) / 2); }

  void sum_within(std::span<const std::size_t> group, std::vector<double>& sums) const {
    sums.assign(count_, 0);
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double* pair = &values_[(group[i] * runs_ + group[j]) * count_];
        for (std::size_t k = 0; k < count_; ++k) sums[k] += pair[k];
      }
    }
  }

  std::size_t runs_, count_;
  std::vector<double> values_, sums_;
  std::vector<double> a_, b_;  ///< Sums within the groups of a permutation.
};

/// Returns for each value the share of values that are at least as large.
std::vector<double> shares_above(const std::vector<double>& values, double tie) {
  std::vector<double> sorted = values, shares;
  std::ranges::sort(sorted);
  for (const double value : values) {
    const auto above = sorted.end() - std::ranges::lower_bound(sorted, value - tie);
    shares.push_back(static_cast<double>(above) / static_cast<double>(values.size()));
  }
  return shares;
}

}  // namespace

void DistanceMatrix::add(const DistanceMatrix& other, double factor) {
  SUNDER_CHECK(other.runs_ == runs_);
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += factor * other.values_[i];
}

double DistanceMatrix::largest() const { return std::ranges::max(values_); }

DistanceMatrix DistanceMatrix::part(std::span<const std::size_t> runs) const {
  DistanceMatrix found(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) found.set(i, j, (*this)(runs[i], runs[j]));
  return found;
}

double spread(const DistanceMatrix& distances, std::span<const std::size_t> group) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (group[i] == group[j]) continue;
      sum += distances(group[i], group[j]);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

double difference(const DistanceMatrix& distances, std::span<const std::size_t> a,
                  std::span<const std::size_t> b) {
  double between = 0;
  for (const std::size_t i : a)
    for (const std::size_t j : b) between += distances(i, j);
  return between / static_cast<double>(a.size() * b.size()) -
         (spread(distances, a) + spread(distances, b)) / 2;
}

std::vector<double> permutation_p(std::span<const DistanceMatrix> matrices, std::size_t count) {
  if (matrices.empty()) return {};
  Interleaved distances(matrices);
  SUNDER_CHECK(count >= 2 && distances.runs() >= count + 2);
  std::vector<std::size_t> order(distances.runs());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::vector<double>> found(matrices.size());  // by matrix, then permutation
  std::vector<double> differences(matrices.size());
  Random random(1);
  for (std::size_t i = 0; i < kPermutations; ++i) {
    distances.differences(order, count, differences);
    for (std::size_t k = 0; k < matrices.size(); ++k) found[k].push_back(differences[k]);
    shuffle(order, random);
  }
  std::vector<double> p, least(kPermutations, 1);  // the least p of each permutation
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    const std::vector<double> shares = shares_above(found[k], kTie * distances.mean(k));
    p.push_back(shares[0]);
    std::ranges::transform(least, shares, least.begin(),
                           [](double a, double b) { return std::min(a, b); });
  }
  std::ranges::sort(least);
  for (double& each : p)
    each = static_cast<double>(std::ranges::upper_bound(least, each) - least.begin()) /
           static_cast<double>(kPermutations);
  return p;
}

}  // namespace sunder::scenes
