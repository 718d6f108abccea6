// Tests that the obstacle grid has the contacts of a search over all obstacles.
#include "solver/particles/obstacle_grid.h"

#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver::obstacle_grid_test {
namespace {

constexpr double kDt = 1.0 / 60;
const Box kEverywhere{Vec3::Constant(-1e6), Vec3::Constant(1e6)};

Vec3 random_place(Random& random, double reach_m) {
  return reach_m * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

/// Adds boxes and balls from a centimetre to several metres, some of which move and rotate.
void scatter(Random& random, TestObstacles& obstacles) {
  for (int i = 0; i < 300; ++i) {
    const double size_m = 0.02 * std::exp2(random.uniform(0, 6));
    const Vec3 center = random_place(random, 6);
    const std::size_t body =
        i % 3 ? obstacles.add_box(center, size_m * Vec3(0.3, 1, random.uniform(0.1, 2)),
                                  Quat(Eigen::AngleAxisd(3 * random.uniform(), random.direction())))
              : obstacles.add_ball(center, size_m);
    if (i % 4) continue;
    obstacles.set_velocity(body, random_place(random, 10));
    obstacles.bodies[body].angular_velocity_W = random_place(random, 3);
  }
}

void expect_contacts_of_all(Random& random, const ObstacleGrid& grid, std::size_t shapes,
                            double apart_m, double path_m, std::size_t count = 8) {
  ObstacleGrid::Near near, all;
  all.shapes.resize(shapes);
  std::iota(all.shapes.begin(), all.shapes.end(), 0u);
  int touched = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<SpherePath> paths(count);
    const Vec3 place = random_place(random, 6);
    for (SpherePath& path : paths) {
      path.from = place + random_place(random, apart_m);
      path.to = path.from + random_place(random, path_m);
      path.radius_m = 0.02 * random.uniform();
      path.duration_s = kDt;
    }
    std::vector<std::optional<SphereContact>> found(count), expected(count);
    grid.find(paths, near);
    grid.sweep(paths, near, found);
    grid.sweep(paths, all, expected);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      ASSERT_EQ(found[i].has_value(), expected[i].has_value()) << round << ", way " << i;
      if (!found[i]) continue;
      ++touched;
      ASSERT_EQ(found[i]->time, expected[i]->time) << round << ", way " << i;
      if (expected[i]->time == 0) continue;  // The sphere may start inside several obstacles.
      ASSERT_EQ(found[i]->body, expected[i]->body) << round << ", way " << i;
    }
  }
  EXPECT_GT(touched, 20);
  EXPECT_LT(touched, 98 * static_cast<int>(count));
}

TEST(ObstacleGrid, FindsTheContactsOfASearchOverAllObstacles) {
  Random random(5);
  TestObstacles obstacles;
  scatter(random, obstacles);
  ObstacleGrid grid;
  grid.build(obstacles.view(), kDt, kEverywhere, ObstacleGrid::Which::kAll);
  // All paths are looked up together.
  expect_contacts_of_all(random, grid, obstacles.shapes.size(), 0.2, 0.2);
  // Each path is looked up by itself.
  expect_contacts_of_all(random, grid, obstacles.shapes.size(), 3, 0.5);
}

TEST(ObstacleGrid, SearchesOnlyAlongALongPath) {
  Random random(6);
  TestObstacles obstacles;
  for (int i = 0; i < 4000; ++i)
    obstacles.add_box(random_place(random, 12), Vec3::Constant(0.1), Quat::Identity());
  ObstacleGrid grid;
  grid.build(obstacles.view(), kDt, kEverywhere, ObstacleGrid::Which::kAll);
  const SpherePath path{Vec3::Constant(-30), Vec3::Constant(30), 0.01, kDt};
  ObstacleGrid::Near near;
  grid.find({&path, 1}, near);
  EXPECT_LT(near.shapes.size(), 300u);
  expect_contacts_of_all(random, grid, obstacles.shapes.size(), 3, 6);
  expect_contacts_of_all(random, grid, obstacles.shapes.size(), 3, 20, 1);
  // Paths longer than all parts.
  expect_contacts_of_all(random, grid, obstacles.shapes.size(), 3, 300);
}

std::optional<SphereContact> touch_at_rest(const ObstacleGrid& grid, const Vec3& place,
                                           double radius_m) {
  ObstacleGrid::Near near;
  const SpherePath path{place, place, radius_m, kDt};
  std::optional<SphereContact> touch;
  grid.find({&path, 1}, near);
  grid.sweep({&path, 1}, near, {&touch, 1});
  return touch;
}

TEST(ObstacleGrid, FindsABodyThatPassedWithinTheStep) {
  TestObstacles obstacles;
  // Half a metre per step: the box's front moved from 0.05 m to 0.55 m.
  const Vec3 velocity(30, 0, 0);
  obstacles.set_velocity(obstacles.add_box(Vec3(0.5, 0, 0), Vec3(0.05, 0.3, 0.3)), velocity);
  const Vec3 place(0.25, 0, 0);
  ObstacleGrid grid;
  grid.build(obstacles.view(), kDt, {place, place}, ObstacleGrid::Which::kMoving);
  const std::optional<SphereContact> touch = touch_at_rest(grid, place, 0.01);
  ASSERT_TRUE(touch.has_value());
  EXPECT_NEAR(touch->time, (0.24 - 0.05) / 0.5, 1e-3);
  EXPECT_LE((touch->normal_W - Vec3::UnitX()).norm(), 1e-5);
  EXPECT_LE((touch->velocity_W - velocity).norm(), 1e-4);
}

TEST(ObstacleGrid, HasOnlyTheRequestedObstacles) {
  TestObstacles obstacles;
  obstacles.add_ball(Vec3::Zero(), 0.1);
  obstacles.set_velocity(obstacles.add_ball(Vec3(1, 0, 0), 0.1), Vec3(0, 0.1, 0));
  obstacles.set_velocity(obstacles.add_ball(Vec3(2, 0, 0), 0.1), Vec3(0, 0.01, 0));
  const std::size_t spinning = obstacles.add_ball(Vec3(3, 0, 0), 0.1);
  obstacles.set_velocity(spinning, Vec3::Zero());
  obstacles.bodies[spinning].angular_velocity_W = Vec3(0, 1, 0);
  const auto touched = [&](ObstacleGrid::Which which, const Box& region) {
    ObstacleGrid grid;
    grid.build(obstacles.view(), kDt, region, which);
    std::array<bool, 4> each;
    for (std::size_t i = 0; i < 4; ++i) {
      each[i] = touch_at_rest(grid, static_cast<double>(i) * Vec3::UnitX(), 0.01).has_value();
    }
    return each;
  };
  using Touched = std::array<bool, 4>;
  EXPECT_EQ(touched(ObstacleGrid::Which::kAll, kEverywhere), (Touched{true, true, true, true}));
  EXPECT_EQ(touched(ObstacleGrid::Which::kMoving, kEverywhere), (Touched{false, true, false, true}))
      << "what creeps lies still";
  const Box right{Vec3(1.5, -1, -1), Vec3(2.5, 1, 1)};
  EXPECT_EQ(touched(ObstacleGrid::Which::kAll, right), (Touched{false, false, true, false}));
  EXPECT_EQ(touched(ObstacleGrid::Which::kAll, Box()), (Touched{false, false, false, false}));
}

}  // namespace
}  // namespace sunder::solver::obstacle_grid_test
