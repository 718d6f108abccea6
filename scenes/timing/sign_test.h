// The sign test: compares two programs by pairs of runs that were timed at once.
//
// Two identical programs are equally likely to be the slower one of a pair, whatever the
// distribution of times, and whatever slows both runs of the pair. The number of pairs in which one
// is slower is then that of heads in as many tosses of a coin, so that its probabilities are exact.
// Unlike the signed-rank test, this needs no symmetric differences, and one run that was disturbed
// for long counts as one pair, however long it took.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace sunder::scenes {

/// Returns the probability of at least `heads` heads in `tosses` tosses of a coin.
double heads_probability(std::size_t heads, std::size_t tosses);

/// Returns the least number of pairs that can show a difference with an error of at most `error`:
/// all of them have to agree.
std::size_t least_pairs(double error);

/// Interval of the median of a ratio.
struct RatioInterval {
  double low = 1, high = 1;
};

/// Returns the interval of the ratio of `now` to `before`, the values of each pair: its low end is
/// above the median with a probability of at most `error`, and so is its high end below. The ends
/// are measured ratios, so that the low end exceeds a bound if, and only if, the sign test rejects
/// that bound. Returns nullopt if there are too few pairs. Values below `least`, which must be
/// positive, count as `least`.
std::optional<RatioInterval> ratio_interval(std::span<const double> now,
                                            std::span<const double> before, double least,
                                            double error);

}  // namespace sunder::scenes
