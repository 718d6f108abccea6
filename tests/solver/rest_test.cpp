// Tests of rest: piles fall asleep, and what moves slowly does not.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/hull.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver::rest_test {
namespace {

using W = RigidWorld;

/// Adds a pile of 80 to 240 boxes, lumps or both, by the seed.
std::vector<BodyId> add_pile(RigidWorld& world, std::uint64_t seed) {
  Random random(seed);
  const int kind = static_cast<int>(seed % 3), count = 80 + static_cast<int>(random.below(160));
  const double friction = random.uniform(0.3, 0.8), restitution = random.uniform(0, 0.3),
               scale = std::exp(random.uniform(-1, 0.4));
  world.add(W::ground());
  std::vector<BodyId> pile;
  for (int i = 0; i < count; ++i) {
    Vec3 at(i % 5, 0.7 + i / 25, i / 5 % 5);
    at.x() += random.uniform(0, 0.15);
    at.z() += random.uniform(0, 0.15);
    at *= 0.5 * scale;
    const double size = scale * random.uniform(0.1, 0.4);
    std::vector<Vec3> points(8 + random.below(9));
    for (Vec3& point : points) point = 0.5 * size * random.direction();
    Vec3 sides(0, 0.8 * size, 0);
    sides.x() = size * random.uniform(0.3, 1);
    sides.z() = size * random.uniform(0.3, 1);
    const bool is_box = kind == 2 ? i % 2 == 0 : kind == 0;
    const BodyDesc body = is_box ? W::box(sides, at, 2000) : W::hull(make_hull(points), at, 2000);
    pile.push_back(world.add(W::with_friction(body, friction, restitution)));
  }
  return pile;
}

TEST(Rest, AllOfTenPilesSleepAfterSevenSeconds) {
  for (const Preset& preset : kPresets) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      RigidWorld world(options_of(preset));
      const std::vector<BodyId> pile = add_pile(world, seed);
      world.run(7, preset.dt_s, preset.substeps);
      const auto awake =
          std::ranges::count_if(pile, [&](BodyId id) { return !world.state(id).asleep; });
      EXPECT_EQ(awake, 0) << preset.name << ", pile " << seed << " of " << pile.size();
    }
  }
}

TEST(Rest, ABallThatRollsAtAHundredthOfItsSpeedOfFallingDoesNotSleep) {
  for (const Preset& preset : kPresets) {
    for (const double radius_m : {0.05, 0.2, 1.}) {
      RigidWorld world(options_of(preset));
      world.add(W::ground());
      const double speed_m_s = 0.02 * std::sqrt(kG * radius_m);
      BodyDesc ball = W::moving(W::sphere(radius_m, Vec3(0, radius_m, 0)), Vec3(speed_m_s, 0, 0));
      ball.angular_velocity_W = Vec3(0, 0, -speed_m_s / radius_m);
      const BodyId id = world.add(W::with_friction(ball, 0.5, 0));
      world.run(10, preset.dt_s, preset.substeps);
      EXPECT_FALSE(world.state(id).asleep) << preset.name << ", " << radius_m;
      EXPECT_NEAR(world.state(id).X_WB.position.x(), 10 * speed_m_s, 0.01 * 10 * speed_m_s);
    }
  }
}

/// A column falls if it leans by more than its balance, however little.
TEST(Rest, AColumnThatLeansByAHundredthMoreThanItsBalanceFalls) {
  for (const Preset& preset : kPresets) {
    for (const double height_m : {0.3, 2., 20.}) {
      RigidWorld world(options_of(preset));
      world.add(W::ground());
      const double width_m = 0.2 * height_m, lean_rad = std::atan(0.2) + 0.01;
      const Quat lean(Eigen::AngleAxisd(-lean_rad, Vec3::UnitZ()));
      const Vec3 corner(0.5 * width_m, -0.5 * height_m, 0);
      BodyDesc column =
          W::box(Vec3(width_m, height_m, width_m), Vec3(0, -(lean * corner).y(), 0), 2000);
      column.X_WB.rotation = lean;
      const BodyId id = world.add(W::with_friction(column, 0.8, 0));
      world.run(8 * std::sqrt(height_m), preset.dt_s, preset.substeps);
      EXPECT_LT(world.state(id).X_WB.position.y(), 0.25 * height_m)
          << preset.name << ", " << height_m;
    }
  }
}

}  // namespace
}  // namespace sunder::solver::rest_test
