// Confidence intervals of how much longer one program takes than another, from a few runs of each.
#pragma once

#include <span>

namespace sunder::bench {

/// Confidence interval of a ratio. Its ends are order statistics of measured ratios, so it holds
/// for any distribution of times.
struct RatioInterval {
  double low = 1, high = 1;
  /// At least kConfidence, or less if the runs are too few: the ends are then the least and the
  /// largest ratio. 0 for one run of each.
  double confidence = 0;
};

inline constexpr double kConfidence = 0.95;

/// Interval of the ratio of times `now` to times `before`, neither empty. `paired`: the runs of one
/// number were made at once, so each is compared with its partner (sign test); else each with every
/// run before (Mann and Whitney, Hodges and Lehmann).
RatioInterval ratio_interval(std::span<const double> now, std::span<const double> before,
                             bool paired);

}  // namespace sunder::bench
