// Tests of the Pareto front of a study, on points made by hand.
#include "scenes/trade/front.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sunder::scenes {
namespace {

using Front = std::vector<std::size_t>;

TEST(Front, HasTheUndominatedPointsCheapestFirst) {
  const std::vector<TradePoint> points = {{"dear, good", false, 8, 1},
                                          {"dear, bad", true, 9, 5},
                                          {"cheap, bad", false, 1, 10},
                                          {"beaten in error alone", false, 8, 2},
                                          {"beaten in cost alone", false, 10, 1},
                                          {"middle", false, 2, 4}};
  EXPECT_EQ(pareto_front(points), (Front{2, 5, 0}));
  EXPECT_EQ(pareto_front({}), Front());
}

TEST(Front, OfEqualPointsHasTheFirst) {
  const std::vector<TradePoint> points = {{"", false, 2, 3}, {"", false, 2, 3}, {"", false, 1, 4}};
  EXPECT_EQ(pareto_front(points), (Front{2, 0}));
}

TEST(Front, IsInterpolatedLinearlyInLogarithms) {
  // On the line from (1, 100) to (16, 1) an error of 10 has a cost of 4.
  const std::vector<TradePoint> points = {
      {"", false, 1, 100}, {"", false, 16, 1}, {"", true, 6, 10}};
  ASSERT_EQ(pareto_front(points), (Front{0, 2, 1}));
  const std::vector<TradePoint> over = {
      {"", false, 1, 100}, {"", false, 16, 1}, {"", false, 20, 0.5}, {"", true, 17, 10}};
  EXPECT_NEAR(over_front(over, 3), 17.0 / 4, 1e-12);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(over_front(points, i), 1, 1e-12);
}

TEST(Front, ComparesPointsWorseThanTheCheapestWithTheCheapest) {
  const std::vector<TradePoint> points = {{"", false, 2, 10}, {"", true, 3, 20}, {"", true, 2, 11}};
  EXPECT_NEAR(over_front(points, 1), 1.5, 1e-12);
  EXPECT_NEAR(over_front(points, 2), 1, 1e-12);
}

TEST(Front, AcceptsAnErrorOfZero) {
  const std::vector<TradePoint> points = {{"", false, 1, 1}, {"", false, 2, 0}, {"", true, 3, 0}};
  EXPECT_EQ(pareto_front(points), (Front{0, 1}));
  EXPECT_NEAR(over_front(points, 2), 1.5, 1e-12);
}

}  // namespace
}  // namespace sunder::scenes
