// Tests whether two groups of runs have the same distribution, from the distances between runs
// alone: the energy distance (Székely and Rizzo 2013), judged by permutations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/random.h"

namespace sunder::scenes {

/// Puts indices into a random order.
inline void shuffle(std::span<std::size_t> order, Random& random) {
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const auto left = static_cast<std::uint32_t>(order.size() - i);
    std::swap(order[i], order[i + random.below(left)]);
  }
}

/// Distances between runs: a symmetric matrix with zeros on its diagonal.
class DistanceMatrix {
 public:
  explicit DistanceMatrix(std::size_t runs) : runs_(runs), values_(runs * runs) {}

  std::size_t runs() const { return runs_; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * runs_ + j]; }
  void set(std::size_t i, std::size_t j, double distance) {
    values_[i * runs_ + j] = values_[j * runs_ + i] = distance;
  }
  /// Adds another matrix of as many runs, times a factor.
  void add(const DistanceMatrix& other, double factor);
  /// Returns the largest distance of two runs.
  double largest() const;
  /// Returns the matrix of some of the runs, in this order.
  DistanceMatrix part(std::span<const std::size_t> runs) const;

 private:
  std::size_t runs_;
  std::vector<double> values_;
};

/// Returns the mean distance of pairs of runs of a group; 0 without pairs. A pair of a run that was
/// drawn twice does not count.
double spread(const DistanceMatrix& distances, std::span<const std::size_t> group);

/// Returns the mean distance between a run of one group and a run of the other, less the mean
/// distance between two runs of one group: half the energy distance. Its mean is 0 for groups of
/// one distribution, whatever their sizes, and above 0 for others.
double difference(const DistanceMatrix& distances, std::span<const std::size_t> a,
                  std::span<const std::size_t> b);

/// Returns for each matrix the probability of its difference between the first `count` runs and the
/// others, if both are of one distribution, by permutations of the runs. Probabilities are
/// corrected for the number of matrices (minP of Westfall and Young 1993): that any is at most x
/// has probability x at most. All matrices have the same runs; each group has two or more.
std::vector<double> permutation_p(std::span<const DistanceMatrix> matrices, std::size_t count);

}  // namespace sunder::scenes
