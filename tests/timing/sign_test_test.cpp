// Tests that the sign test has the errors that it claims, for any distribution of times.
#include "scenes/timing/sign_test.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::scenes {
namespace {

std::vector<double> from_one(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST(SignTest, HasTheProbabilitiesOfACoin) {
  EXPECT_NEAR(heads_probability(5, 5), 1 / 32.0, 1e-12);
  EXPECT_NEAR(heads_probability(4, 5), 6 / 32.0, 1e-12);
  EXPECT_NEAR(heads_probability(0, 9), 1, 1e-12);
  EXPECT_EQ(heads_probability(0, 0), 1);
  EXPECT_NEAR(heads_probability(500, 1000), 0.5 + 0.5 * 0.025225, 1e-5) << "half, and half a tie";
}

TEST(SignTest, TakesAsManyPairsAsCanAllAgreeByChance) {
  EXPECT_EQ(least_pairs(0.05), 5u);
  EXPECT_EQ(least_pairs(0.05 / 16), 9u);
  EXPECT_EQ(least_pairs(0.05 / 64), 11u);
  const std::vector<double> four = from_one(4), five = from_one(5);
  EXPECT_FALSE(ratio_interval(four, four, 0.1, 0.05));
  EXPECT_TRUE(ratio_interval(five, five, 0.1, 0.05));
}

TEST(SignTest, LeavesOutRatiosAtBothEndsWhereThereAreEnough) {
  const std::vector<double> before(9, 1.0), now = {9, 2, 3, 4, 5, 6, 7, 8, 1};
  const auto most = ratio_interval(now, before, 0.1, 0.01);  // 1 / 512, and 10 / 512 for one more
  ASSERT_TRUE(most);
  EXPECT_EQ(most->low, 1);
  EXPECT_EQ(most->high, 9);
  const auto fewer = ratio_interval(now, before, 0.1, 0.02);
  ASSERT_TRUE(fewer);
  EXPECT_EQ(fewer->low, 2);
  EXPECT_EQ(fewer->high, 8);
}

TEST(SignTest, TimesBelowTheLeastCountAsTheLeast) {
  const std::vector<double> before(5, 0.01), now = {0.19, 0.19, 0.19, 0.19, 0.4};
  const auto interval = ratio_interval(now, before, 0.2, 0.05);
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->low, 1);
  EXPECT_EQ(interval->high, 2);
}

/// Returns the share of intervals whose low end is above the true ratio, 1.1, for times whose
/// distribution has a long tail, and of which both of a pair are slowed by as much.
double share_above(std::size_t pairs, double error) {
  constexpr int kTrials = 4000;
  Random random(7);
  int above = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> now, before;
    for (std::size_t i = 0; i < pairs; ++i) {
      const double common = std::exp(3 * random.uniform());
      now.push_back(1.1 * common * (1 - 0.1 * std::log(1 - random.uniform())));
      before.push_back(common * (1 - 0.1 * std::log(1 - random.uniform())));
    }
    above += ratio_interval(now, before, 1e-6, error)->low > 1.1 ? 1 : 0;
  }
  return above / double{kTrials};
}

TEST(SignTest, IsWrongAsOftenAsItClaims) {
  for (const std::size_t pairs : {5u, 8u, 15u, 40u}) {
    EXPECT_LT(share_above(pairs, 0.05), 0.06) << pairs;
    EXPECT_GT(share_above(pairs, 0.05), 0.005)
        << pairs << ": an interval that always holds is none";
  }
}

}  // namespace
}  // namespace sunder::scenes
