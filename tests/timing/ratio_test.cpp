// Tests that confidence intervals of ratios contain the true ratio as often as they claim.
#include "scenes/timing/ratio.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::scenes {
namespace {

TEST(RatioInterval, HasTheConfidenceOfItsOrderStatistics) {
  const std::vector<double> one = {2}, four = {1, 2, 3, 4}, five = {1, 2, 3, 4, 5};
  EXPECT_EQ(ratio_interval(one, one, false).confidence, 0);
  EXPECT_NEAR(ratio_interval(four, four, false).confidence, 1 - 2 / 70.0, 1e-12);
  EXPECT_NEAR(ratio_interval(five, five, false).confidence, 1 - 8 / 252.0, 1e-12);
  EXPECT_NEAR(ratio_interval(five, five, true).confidence, 1 - 2 / 32.0, 1e-12);
  EXPECT_NEAR(ratio_interval(five, one, false).confidence, 1 - 2 / 6.0, 1e-12);
}

TEST(RatioInterval, LeavesOutRatiosAtBothEndsWhereThereAreEnough) {
  const std::vector<double> before = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  const std::vector<double> now = {9, 2, 3, 4, 5, 6, 7, 8, 1};
  const RatioInterval interval = ratio_interval(now, before, true);  // the second and the eighth
  EXPECT_EQ(interval.low, 2);
  EXPECT_EQ(interval.high, 8);
  EXPECT_NEAR(interval.confidence, 1 - 20 / 512.0, 1e-12);
}

/// Returns the share of intervals that contain the true ratio, 1.1, for times whose distribution
/// has a long tail.
double coverage(std::size_t runs, bool paired) {
  constexpr int kTrials = 2000;
  Random random(7);
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> now, before;
    for (std::size_t i = 0; i < runs; ++i) {
      const double common = paired ? std::exp(random.uniform()) : 1;
      now.push_back(1.1 * common * (1 - 0.1 * std::log(1 - random.uniform())));
      before.push_back(common * (1 - 0.1 * std::log(1 - random.uniform())));
    }
    const RatioInterval interval = ratio_interval(now, before, paired);
    held += interval.low <= 1.1 && 1.1 <= interval.high ? 1 : 0;
  }
  return held / double{kTrials};
}

TEST(RatioInterval, ContainsTheRatioAsOftenAsItClaims) {
  for (const std::size_t runs : {5u, 8u, 20u, 80u}) {
    EXPECT_GT(coverage(runs, false), 0.94) << runs;
    EXPECT_GT(coverage(runs, true), runs == 5 ? 0.92 : 0.94) << runs;
  }
}

}  // namespace
}  // namespace sunder::scenes
