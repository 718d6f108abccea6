// Distribution of an impulse over many contact points.
#include "solver/impact/impulse_distribution.h"

#include <vector>

#include <gtest/gtest.h>

namespace sunder::solver {
namespace {

/// Sum and moment.
std::pair<Vec3, Vec3> wrench(const std::vector<ContactPointImpulse>& points) {
  std::pair<Vec3, Vec3> sum(Vec3::Zero(), Vec3::Zero());
  for (const ContactPointImpulse& point : points) {
    sum.first += point.impulse_Ns * point.direction_W;
    sum.second += point.impulse_Ns * point.arm_W.cross(point.direction_W);
  }
  return sum;
}

std::vector<ContactPointImpulse> grid(int side) {
  std::vector<ContactPointImpulse> points;
  for (int i = 0; i < side * side; ++i)
    points.push_back({0, Vec3(i % side, -1, i / side) - Vec3(1, 0, 1), Vec3::UnitY(), 0});
  return points;
}

TEST(EvenLoad, OfWhatLiesFlatIsTheSameEverywhereWhicheverPointsWereFound) {
  std::vector<ContactPointImpulse> points = grid(3);
  for (const std::size_t corner : {0, 2, 6, 8}) points[corner].impulse_Ns = 9;
  distribute_evenly(points);
  for (const ContactPointImpulse& point : points) EXPECT_NEAR(point.impulse_Ns, 4, 1e-12);
}

TEST(EvenLoad, KeepsSumAndMoment) {
  std::vector<ContactPointImpulse> points = grid(3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].impulse_Ns = i == 4 ? 30 : 1 + 0.2 * static_cast<double>(i % 4);
    points[i].direction_W = Vec3(0.1 * static_cast<double>(i % 2), 1, 0).normalized();
  }
  const auto before = wrench(points);
  distribute_evenly(points);
  EXPECT_LT(points[4].impulse_Ns, 10);
  const auto after = wrench(points);
  EXPECT_LT((after.first - before.first).norm(), 1e-9);
  EXPECT_LT((after.second - before.second).norm(), 1e-9);
}

TEST(EvenLoad, StaysWhereItIsIfSomePointWouldHaveToPull) {
  std::vector<ContactPointImpulse> points = grid(3);
  points[0].impulse_Ns = 5;  // on an edge
  distribute_evenly(points);
  EXPECT_EQ(points[0].impulse_Ns, 5);
  EXPECT_EQ(points[8].impulse_Ns, 0);
}

}  // namespace
}  // namespace sunder::solver
