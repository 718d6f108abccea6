// Tests of the error between two sets of runs, on samples of known distributions.
#include "scenes/trade/errors.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::scenes {
namespace {

constexpr int kSeeds = 8, kTrials = 400;

/// Returns a nearly normal random number of mean 0 and standard deviation 1.
double draw(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// Returns runs of `samples` samples each. The samples of a run share a random offset, so that
/// seeds differ as well as samples of one run.
std::vector<Facts> runs(Random& random, std::size_t samples, double mean, int seeds = kSeeds) {
  std::vector<Facts> all(static_cast<std::size_t>(seeds));
  for (Facts& facts : all) {
    const double offset = mean + draw(random);
    for (std::size_t i = 0; i < samples; ++i)
      facts.samples["run-out m"].push_back(samples == 1 ? offset : offset + draw(random));
  }
  return all;
}

/// Error over noise: its mean over the trials, and the share of trials in which it is above 1.
struct Trials {
  double mean = 0, above = 0;
};
Trials run_trials(std::size_t samples, double shift, int seeds = kSeeds) {
  Random random(7);
  Trials trials;
  for (int i = 0; i < kTrials; ++i) {
    const std::vector<Facts> reference = runs(random, samples, 0, seeds);
    const std::vector<TradeError> errors =
        trade_errors(runs(random, samples, shift, seeds), reference);
    const double over = worst(errors);
    trials.mean += over / kTrials;
    trials.above += (over > 1 ? 1.0 : 0.0) / kTrials;
  }
  return trials;
}

TEST(Errors, DistanceIsTheMeanMotionOfSamples) {
  EXPECT_DOUBLE_EQ(distance_between({1}, {4}), 3);
  EXPECT_DOUBLE_EQ(distance_between({0, 1, 2}, {2, 1, 0}), 0);
  EXPECT_DOUBLE_EQ(distance_between({0, 1, 2}, {3, 5, 4}), 3);
  EXPECT_DOUBLE_EQ(distance_between({0, 10}, {0, 0, 0, 10}), 2.5);
  EXPECT_DOUBLE_EQ(distance_between({0, 0, 0, 10}, {0, 10}), 2.5);
  EXPECT_DOUBLE_EQ(distance_between({-1, 1}, {0}), 1);
  EXPECT_EQ(distance_between({0, std::nan("")}, {0}), std::numeric_limits<double>::infinity());
}

TEST(Errors, OfEqualDistributionsAreAboutOne) {
  for (const std::size_t samples : {std::size_t{1}, std::size_t{30}}) {
    const Trials same = run_trials(samples, 0);
    std::printf("%zu samples a run: %.2f, above 1 in %.2f\n", samples, same.mean, same.above);
    EXPECT_GT(same.mean, 0.5);
    EXPECT_LT(same.mean, 1.5);
  }
}

TEST(Errors, GrowWithTheShift) {
  const double at_8 = run_trials(1, 8).mean, at_16 = run_trials(1, 16).mean,
               at_32 = run_trials(1, 32).mean;
  EXPECT_GT(at_8, 5);
  EXPECT_NEAR(at_16 / at_8, 2, 0.01);
  EXPECT_NEAR(at_32 / at_16, 2, 0.01);
}

TEST(Errors, GrowWithTheRootOfTheNumberOfSeeds) {
  const double ratio = run_trials(1, 8, 32).mean / run_trials(1, 8, 8).mean;
  EXPECT_NEAR(ratio, 2, 0.4);  // square root of four times as many seeds
}

Facts one(const std::string& name, std::vector<double> samples) {
  return {{{name, std::move(samples)}}, ""};
}

TEST(Errors, OfConstantQuantitiesAreOverTheNoiseFloor) {
  const std::vector<Facts> reference(kSeeds, one("penetration p99 m", {1e-6}));
  const std::vector<Facts> point(kSeeds, one("penetration p99 m", {3.001e-3}));
  const std::vector<TradeError> errors = trade_errors(point, reference);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(errors[0].distance, 3e-3, 1e-12);
  EXPECT_DOUBLE_EQ(errors[0].noise, 1e-3);
  EXPECT_NEAR(worst(errors), 3, 1e-9);
  const std::vector<double> far = {4, 6};
  EXPECT_DOUBLE_EQ(noise_floor("run-out m", far), 0.05);
  EXPECT_DOUBLE_EQ(noise_floor("pieces", far), 1);
}

TEST(Errors, LeaveOutQuantitiesThatOneSideLacks) {
  const std::vector<Facts> reference = {one("exit speed m/s", {10}), one("drift m", {})};
  const std::vector<Facts> point = {one("drift m", {1e-3}), one("pieces", {3})};
  EXPECT_TRUE(trade_errors(point, reference).empty());
  EXPECT_EQ(worst(trade_errors(point, reference)), 0);
  const std::vector<Facts> fewer = {one("exit speed m/s", {12})};
  EXPECT_NEAR(worst(trade_errors(fewer, reference)), 20, 1e-9);  // 2 m/s over 1 % of 10
}

}  // namespace
}  // namespace sunder::scenes
