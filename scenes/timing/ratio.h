// Confidence intervals of the ratio of the run times of two programs, from a few runs of each.
#pragma once

#include <span>

namespace sunder::scenes {

/// Confidence interval of a ratio. The ends are order statistics of measured ratios, so the
/// interval holds for any distribution of times.
struct RatioInterval {
  double low = 1, high = 1;
  /// At least kConfidence; less if there are too few runs, where the ends are the least and the
  /// largest ratio. 0 for one run of each.
  double confidence = 0;
};

inline constexpr double kConfidence = 0.95;

/// Returns the interval of the ratio of times `now` to times `before`, neither of them empty.
/// `paired`: runs of one number were made at once and are compared with each other (sign test);
/// otherwise every run is compared with every run before (Mann and Whitney, Hodges and Lehmann).
RatioInterval ratio_interval(std::span<const double> now, std::span<const double> before,
                             bool paired);

}  // namespace sunder::scenes
