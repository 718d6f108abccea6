// Tests of the error between two groups of runs, on samples of known distributions.
#include "scenes/trade/errors.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kSeeds = 8;

/// Returns a nearly normal random number of mean 0 and standard deviation 1.
double draw(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

using MakeRun = std::function<Facts(Random&)>;

std::vector<Facts> runs(Random& random, const MakeRun& make, std::size_t count) {
  std::vector<Facts> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(make(random));
  return all;
}

/// Returns a run of so many figures that have a part in common; the first three have 20 samples.
/// The first figure is shifted by so many standard deviations.
MakeRun correlated(int figures, double shift = 0) {
  return [=](Random& random) {
    Facts facts;
    const double common = draw(random);
    for (int i = 0; i < figures; ++i) {
      const double own = 20 + common + draw(random) + (i == 0 ? std::sqrt(2.0) * shift : 0);
      std::vector<double>& samples = facts.samples["figure " + std::to_string(i) + " m"];
      for (int k = 0; k < (i < 3 ? 20 : 1); ++k)
        samples.push_back(own + (i < 3 ? draw(random) : 0));
    }
    return facts;
  };
}

/// Returns a run of one figure, normally distributed.
MakeRun normal(double mean, double deviation = 1) {
  return [=](Random& random) {
    return Facts{{{"run-out m", {mean + deviation * draw(random)}}}, ""};
  };
}

/// Returns a run that is discrete, constant or rare in every figure: pieces of one distribution, an
/// even chance of a fall, a constant, and one seed of twenty that is far off.
Facts discrete(Random& random) {
  return {{{"pieces", {static_cast<double>(random.below(3))}},
           {"surface in place share", {random.below(2) == 0 ? 1.0 : 0.2}},
           {"drift largest m", {0.25}},
           {"run-out m", {random.below(20) == 0 ? 100.0 : 1 + draw(random) / 10}}},
          ""};
}

/// Shares of trials in which the groups differ and in which the interval has the true error, and
/// the mean and the deviation of errors.
struct Trials {
  double differ = 0, error = 0, deviation = 0, covered = 0;
};
Trials run_trials(const MakeRun& point, const MakeRun& limit, std::size_t seeds, int count,
                  double truth = 0) {
  Random random(7);
  Trials trials;
  for (int i = 0; i < count; ++i) {
    const std::vector<Facts> reference = runs(random, limit, seeds);
    const PointError found = point_error(runs(random, point, seeds), reference);
    trials.differ += found.differs() ? 1.0 / count : 0;
    trials.error += found.error / count;
    trials.deviation += found.error * found.error / count;
    const bool covers = found.interval.low <= truth && truth <= found.interval.high;
    trials.covered += covers ? 1.0 / count : 0;
  }
  trials.deviation = std::sqrt(trials.deviation - trials.error * trials.error);
  std::printf("%zu seeds: differ %.3f, error %.3f ± %.3f, covered %.3f\n", seeds, trials.differ,
              trials.error, trials.deviation, trials.covered);
  return trials;
}

/// Returns the error of a normal distribution shifted by so many standard deviations, in closed
/// form: the mean of |N(shift, 2)| less that of |N(0, 2)|, over the latter.
double normal_error(double shift) {
  const double spread = 2 / std::sqrt(std::numbers::pi);
  return (spread * std::exp(-shift * shift / 4) + shift * std::erf(shift / 2) - spread) / spread;
}

TEST(Errors, DistanceIsTheMeanMotionOfSamples) {
  using Samples = std::vector<double>;
  EXPECT_DOUBLE_EQ(distance_between(Samples{1}, Samples{4}), 3);
  EXPECT_DOUBLE_EQ(distance_between(Samples{0, 1, 2}, Samples{0, 1, 2}), 0);
  EXPECT_DOUBLE_EQ(distance_between(Samples{0, 1, 2}, Samples{3, 4, 5}), 3);
  EXPECT_DOUBLE_EQ(distance_between(Samples{0, 10}, Samples{0, 0, 0, 10}), 2.5);
  EXPECT_DOUBLE_EQ(distance_between(Samples{0, 0, 0, 10}, Samples{0, 10}), 2.5);
  EXPECT_DOUBLE_EQ(distance_between(Samples{-1, 1}, Samples{0}), 1);
}

/// Returns the share of `count` comparisons of two groups of equal runs in which they differ.
double found_equal(const MakeRun& make, std::size_t seeds, int count) {
  Random random(7);
  std::vector<std::size_t> order(2 * seeds);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const RunDistances::Group all(order);
  double differ = 0;
  for (int i = 0; i < count; ++i) {
    const RunDistances distances(runs(random, make, 2 * seeds));
    differ += distances.compare(all.first(seeds), all.subspan(seeds)).differs() ? 1.0 / count : 0;
  }
  std::printf("%zu seeds: %.3f of %d comparisons find a difference\n", seeds, differ, count);
  return differ;
}

TEST(Errors, OfEqualSettingsAreFoundAtTheStatedRate) {
  EXPECT_NEAR(found_equal(correlated(4), kSeeds, 2000), kFalsePositives, 0.02);
  EXPECT_NEAR(found_equal(normal(0), kSeeds, 2000), kFalsePositives, 0.02);
  EXPECT_NEAR(found_equal(normal(0), 24, 500), kFalsePositives, 0.03);  // three deviations
}

TEST(Errors, OfEqualDiscreteOrConstantFiguresAreFoundAtTheStatedRateAtMost) {
  const double rate = found_equal(discrete, kSeeds, 2000);
  EXPECT_LE(rate, kFalsePositives + 0.02);
  EXPECT_GE(rate, kFalsePositives - 0.03);
  const MakeRun constant = [](Random&) { return Facts{{{"pieces", {3}}}, ""}; };
  EXPECT_EQ(found_equal(constant, kSeeds, 10), 0);
}

TEST(Errors, OfEqualSettingsHaveAMeanOfZeroForAnyNumberOfSeeds) {
  for (const std::size_t seeds : {kSeeds, 3 * kSeeds})
    EXPECT_NEAR(run_trials(correlated(4), correlated(4), seeds, 60).error, 0, 0.03);
}

TEST(Errors, ConvergeToAFixedValueWhilePowerGrowsWithTheSeeds) {
  const double truth = normal_error(1);
  const Trials few = run_trials(normal(1), normal(0), kSeeds, 100, truth);
  const Trials more = run_trials(normal(1), normal(0), 2 * kSeeds, 100, truth);
  const Trials many = run_trials(normal(1), normal(0), 6 * kSeeds, 50, truth);
  EXPECT_GT(more.differ, few.differ + 0.1);
  EXPECT_GT(many.differ, 0.95);
  EXPECT_LT(many.deviation, few.deviation / 2);
  EXPECT_NEAR(few.error, truth, 0.12);
  EXPECT_NEAR(many.error, truth, 0.06);
}

TEST(Errors, OfOneFigureAmongSixteenAreFound) {
  EXPECT_GT(run_trials(correlated(16, 3), correlated(16), kSeeds, 30).differ, 0.9);
}

TEST(Errors, SeeADifferenceInScatterAlone) {
  const Trials wider = run_trials(normal(0, 5), normal(0), 2 * kSeeds, 50);
  EXPECT_GT(wider.differ, 0.9);
  EXPECT_GT(wider.error, 0.3);
}

TEST(Errors, OfAFallInHalfOfTheSeedsAreAQuarterOfThoseOfACertainFall) {
  const auto falls = [](double chance) -> MakeRun {
    return [chance](Random& random) {
      return Facts{{{"surface in place share", {random.uniform() < chance ? 0.5 : 1.0}}}, ""};
    };
  };
  const Trials certain = run_trials(falls(1), falls(0), kSeeds, 10);
  const Trials half = run_trials(falls(0.5), falls(0), 3 * kSeeds, 60);
  EXPECT_NEAR(certain.error, 50, 1e-9);  // half of the surface, in units of 1 %
  EXPECT_NEAR(half.error, 12.5, 2);      // half of 50, less half of the scatter among these runs
}

TEST(Errors, IntervalsCoverTheError) {
  for (const double shift : {1.0, 3.0}) {
    const Trials found = run_trials(normal(shift), normal(0), 16, 200, normal_error(shift));
    EXPECT_GE(found.covered, 0.8) << shift;  // 0.9 for many seeds
    EXPECT_LE(found.covered, 0.97) << shift;
  }
}

TEST(Errors, OfConstantQuantitiesAreInUnitsOfTheNoiseFloor) {
  const std::vector<Facts> limit(kSeeds, Facts{{{"penetration p99 m", {1e-6}}}, ""});
  const std::vector<Facts> point(kSeeds, Facts{{{"penetration p99 m", {3.001e-3}}}, ""});
  const PointError found = point_error(point, limit);
  ASSERT_EQ(found.figures.size(), 1u);
  EXPECT_NEAR(found.figures[0].difference, 3e-3, 1e-12);
  EXPECT_DOUBLE_EQ(found.figures[0].spread, 1e-3);
  EXPECT_NEAR(found.error, 3, 1e-9);
  EXPECT_EQ(found.largest(), &found.figures[0]);
  EXPECT_DOUBLE_EQ(noise_floor("run-out m", 5), 0.05);
  EXPECT_DOUBLE_EQ(noise_floor("pieces", 5), 1);
}

TEST(Errors, BelowTheNoiseFloorAreNoDifferenceHoweverCertain) {
  const auto facts = [](double drift_m, std::size_t count) {
    return std::vector<Facts>(count, Facts{{{"drift m", {drift_m}}, {"pieces", {3}}}, ""});
  };
  const PointError below = point_error(facts(0.0109, kSeeds), facts(0.01, kSeeds));
  EXPECT_FALSE(below.differs()) << "0.9 mm";
  EXPECT_GT(below.error, 0);
  const PointError above = point_error(facts(0.0111, kSeeds), facts(0.01, kSeeds));
  EXPECT_TRUE(above.differs()) << "1.1 mm";
  EXPECT_TRUE(above.figures[0].differs());
  EXPECT_FALSE(above.figures[1].differs());
}

TEST(Errors, LeaveOutQuantitiesThatARunLacks) {
  const auto facts = [](const char* name, double sample) {
    return Facts{{{name, {sample}}, {"pieces", {3}}}, ""};
  };
  const std::vector<Facts> limit = {facts("exit speed m/s", 10), facts("exit speed m/s", 10)};
  const std::vector<Facts> point = {facts("exit speed m/s", 12), facts("drift m", 1)};
  const PointError found = point_error(point, limit);
  ASSERT_EQ(found.figures.size(), 1u);
  EXPECT_EQ(found.figures[0].name, "pieces");
  const std::vector<Facts> nothing(2);
  EXPECT_EQ(point_error(nothing, nothing).figures.size(), 0u);
  EXPECT_FALSE(point_error(nothing, nothing).differs());
}

TEST(Errors, OfTooFewRunsAreNeverCertain) {
  const PointError found = point_error(std::vector<Facts>(2, Facts{{{"pieces", {90}}}, ""}),
                                       std::vector<Facts>(2, Facts{{{"pieces", {3}}}, ""}));
  EXPECT_GT(found.error, 80);
  EXPECT_GT(found.p, 0.25) << "a third of all permutations separate the groups";
}

}  // namespace
}  // namespace sunder::scenes
