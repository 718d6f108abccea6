// Tests of sleep per body: bodies at rest sleep although others of their island move, and wake when
// their support or load changes.
#include <algorithm>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/piles.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::sleep_test {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;
constexpr int kSubsteps = 4;
const Vec3 kBrick(0.4, 0.2, 0.2);

/// Adds bricks in running bond, row by row, and returns them.
std::vector<BodyId> add_wall(RigidWorld& world, int columns, int rows) {
  std::vector<BodyId> bricks;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      bricks.push_back(world.add(
          W::box(kBrick, Vec3((column + 0.4 * (row % 2)) * kBrick.x(), (row + 0.5) * kBrick.y(), 0),
                 2000)));
  return bricks;
}

std::size_t asleep(const RigidWorld& world, const std::vector<BodyId>& ids) {
  return static_cast<std::size_t>(
      std::count_if(ids.begin(), ids.end(), [&](BodyId id) { return world.state(id).asleep; }));
}

RigidOptions sleeping(bool enabled) {
  RigidOptions options;
  options.sleeping = enabled;
  return options;
}

TEST(Sleep, BodiesAtRestSleepBesideMovingOnes) {
  RigidWorld world;
  world.add(W::ground());
  const std::vector<BodyId> wall = add_wall(world, 8, 8);
  // A ball that spins on the wall forever keeps only itself awake.
  BodyDesc top = W::with_friction(W::sphere(0.1, Vec3(1, 1.7, 0), 100), 0);
  top.angular_velocity_W = Vec3(0, 20, 0);
  const BodyId spinning = world.add(top);
  world.run(6, kDt_s, kSubsteps);
  EXPECT_FALSE(world.state(spinning).asleep);
  EXPECT_EQ(asleep(world, wall), wall.size());
}

TEST(Sleep, NothingWakesDuringTenSecondsOfRest) {
  RigidWorld world;
  world.add(W::ground());
  std::vector<BodyId> pile;
  for (const BodyDesc& box : boxes_of({150, 5, 0.4, 0.1, 5})) pile.push_back(world.add(box));
  world.run(10, kDt_s, kSubsteps);
  std::size_t before = asleep(world, pile), wakes = 0;
  EXPECT_GT(before, pile.size() * 9 / 10);
  for (int i = 0; i < 600; ++i) {
    std::vector<bool> slept;
    for (const BodyId id : pile) slept.push_back(world.state(id).asleep);
    world.step(kDt_s, kSubsteps);
    for (std::size_t b = 0; b < pile.size(); ++b) wakes += slept[b] && !world.state(pile[b]).asleep;
  }
  EXPECT_EQ(wakes, 0u);
  EXPECT_GE(asleep(world, pile), before);
}

TEST(Sleep, NothingSleepsWithoutASupport) {
  RigidWorld world;
  const BodyId plank = world.add(W::box(Vec3(2, 0.1, 0.4), Vec3(0, 50, 0)));
  const BodyId brick = world.add(W::box(kBrick, Vec3(0, 50.15, 0)));
  for (int i = 0; i < 120; ++i) {
    // Impulses alone hold the bodies, so they are at rest without support.
    for (const BodyId id : {plank, brick}) {
      const double mass = id == plank ? 80 : 16;
      world.physics().apply_impulse(id, Vec3(0, 9.81 * kDt_s * mass, 0),
                                    world.state(id).X_WB.position);
    }
    world.step(kDt_s, kSubsteps);
  }
  EXPECT_FALSE(world.state(plank).asleep);
  EXPECT_FALSE(world.state(brick).asleep);
}

/// Returns the vertical speeds of a tower's boxes in the step after the lowest box is removed.
std::vector<double> speeds_without_support(bool sleep) {
  RigidWorld world(sleeping(sleep));
  world.add(W::ground());
  std::vector<BodyId> tower;
  for (int i = 0; i < 12; ++i)
    tower.push_back(world.add(W::box(Vec3(1, 0.5, 1), Vec3(0, 0.25 + 0.5 * i, 0))));
  const BodyId beside = world.add(W::box(Vec3(1, 1, 1), Vec3(3, 0.5, 0)));
  world.run(4, kDt_s, kSubsteps);
  EXPECT_EQ(asleep(world, tower), sleep ? tower.size() : 0);
  world.remove(tower[0]);
  world.step(kDt_s, kSubsteps);
  EXPECT_EQ(world.state(beside).asleep, sleep);
  std::vector<double> speeds;
  for (std::size_t i = 1; i < tower.size(); ++i)
    speeds.push_back(world.state(tower[i]).velocity_W.y());
  return speeds;
}

TEST(Sleep, BodiesOnARemovedSupportFallAsInAWorldWithoutSleep) {
  const std::vector<double> with_sleep = speeds_without_support(true);
  const std::vector<double> without_sleep = speeds_without_support(false);
  EXPECT_LT(without_sleep[0], -0.1);
  for (std::size_t i = 0; i < without_sleep.size(); ++i)
    EXPECT_NEAR(with_sleep[i], without_sleep[i], 1e-3) << i;
}

/// Returns the distance that a body falls within a second.
double fall_m(RigidWorld& world, BodyId body) {
  const double from_m = world.state(body).X_WB.position.y();
  world.run(1, kDt_s, kSubsteps);
  return from_m - world.state(body).X_WB.position.y();
}

TEST(Sleep, ATableFallsOverALegThatCarriedAFifthOfIt) {
  RigidWorld world;
  world.add(W::ground());
  world.add(W::box(Vec3(0.1, 0.8, 0.1), Vec3(-0.2, 0.4, -0.4)));
  world.add(W::box(Vec3(0.1, 0.8, 0.1), Vec3(-0.2, 0.4, 0.4)));
  const BodyId leg = world.add(W::box(Vec3(0.1, 0.8, 0.1), Vec3(0.8, 0.4, 0)));
  const BodyId top = world.add(W::box(Vec3(2, 0.1, 1), Vec3(0, 0.85, 0)));
  world.run(3, kDt_s, kSubsteps);
  ASSERT_TRUE(world.state(top).asleep);
  world.remove(leg);
  EXPECT_GT(fall_m(world, top), 0.2);
}

TEST(Sleep, ABodyFallsAfterItsManySupportsAreRemovedOneByOne) {
  RigidWorld world;
  world.add(W::ground());
  std::vector<BodyId> legs;
  for (int i = 0; i < 60; ++i)
    legs.push_back(
        world.add(W::box(Vec3(0.1, 0.3, 0.1), Vec3(0.2 * (i % 10 - 4.5), 0.15, 0.2 * (i / 10)))));
  const BodyId slab = world.add(W::box(Vec3(2, 0.2, 1.2), Vec3(0, 0.4, 0.5)));
  world.run(4, kDt_s, kSubsteps);
  ASSERT_TRUE(world.state(slab).asleep);
  for (const BodyId leg : legs) world.remove(leg);
  EXPECT_GT(fall_m(world, slab), 0.25);
}

TEST(Sleep, ABodyFollowsAKinematicSupportThatIsLowered) {
  RigidWorld world;
  BodyDesc table = W::box(Vec3(4, 1, 4), Vec3(0, -0.5, 0));
  table.is_kinematic = true;
  const BodyId support = world.add(table);
  const BodyId box = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  world.run(3, kDt_s, kSubsteps);
  ASSERT_TRUE(world.state(box).asleep);
  BodyState state = world.state(support);
  world.physics().set_state(support, state);
  world.step(kDt_s, kSubsteps);
  EXPECT_TRUE(world.state(box).asleep) << "the support is where it was";
  state.X_WB.position.y() -= 0.004;
  world.physics().set_state(support, state);
  EXPECT_NEAR(fall_m(world, box), 0.004, 1e-3);
}

TEST(Sleep, AChangedLoadWakesALightBodyAndNotAHeavyOne) {
  RigidWorld world;
  world.add(W::ground());
  const BodyId heavy = world.add(W::box(Vec3(2, 1, 2), Vec3(0, 0.5, 0), 5000));
  const BodyId light = world.add(W::box(Vec3(1, 0.2, 1), Vec3(5, 0.1, 0), 100));
  world.run(3, kDt_s, kSubsteps);
  ASSERT_TRUE(world.state(heavy).asleep && world.state(light).asleep);
  // The boxes are put down without impact, so only the changed load can wake.
  world.add(W::box(Vec3(0.4, 0.4, 0.4), Vec3(0, 1.2, 0), 1000));
  world.add(W::box(Vec3(0.4, 0.4, 0.4), Vec3(5, 0.4, 0), 1000));
  bool heavy_woke = false, light_woke = false;
  for (int i = 0; i < 30; ++i) {
    world.step(kDt_s, kSubsteps);
    heavy_woke = heavy_woke || !world.state(heavy).asleep;
    light_woke = light_woke || !world.state(light).asleep;
  }
  EXPECT_TRUE(light_woke);
  EXPECT_FALSE(heavy_woke);
}

/// Returns, for each brick above the lowest row, true if it moved by more than a centimetre after
/// ten bricks of that row were removed.
std::vector<bool> moved_without_supports(bool sleep) {
  RigidWorld world(sleeping(sleep));
  world.add(W::ground());
  const std::vector<BodyId> wall = add_wall(world, 20, 10);
  constexpr int kManySubsteps = 12;  // With fewer substeps, a wall that does not sleep sways.
  world.run(2, kDt_s, kManySubsteps);
  std::vector<Vec3> from;
  for (const BodyId id : wall) from.push_back(world.state(id).X_WB.position);
  for (std::size_t removed = 4; removed < 14; ++removed) world.remove(wall[removed]);
  world.run(2, kDt_s, kManySubsteps);
  std::vector<bool> moved;
  for (std::size_t i = 20; i < wall.size(); ++i)
    moved.push_back((world.state(wall[i]).X_WB.position - from[i]).norm() > 0.01);
  return moved;
}

TEST(Sleep, WakesNineTenthsOfTheBodiesThatMoveInAWorldWithoutSleep) {
  const std::vector<bool> without_sleep = moved_without_supports(false),
                          with_sleep = moved_without_supports(true);
  std::size_t moved_without_sleep = 0, moved_in_both = 0;
  for (std::size_t i = 0; i < without_sleep.size(); ++i)
    moved_without_sleep += without_sleep[i], moved_in_both += without_sleep[i] && with_sleep[i];
  std::printf("moved in the twin: %zu of %zu, here too: %zu\n", moved_without_sleep,
              without_sleep.size(), moved_in_both);
  ASSERT_GT(moved_without_sleep, 20u);
  EXPECT_GE(moved_in_both * 10, moved_without_sleep * 9);
}

TEST(Sleep, MomentumAbsorbedBySleepingBodiesIsReported) {
  RigidWorld world;
  world.add(W::ground());
  add_wall(world, 10, 6);
  world.run(3, kDt_s, kSubsteps);
  BodyDesc ball = W::sphere(0.15, Vec3(1.8, 1.3, -4), 7000);
  ball.velocity_W = Vec3(0, 2, 12);
  world.add(ball);
  for (int i = 0; i < 180; ++i) {
    const Vec3 before = world.momentum();
    const SolveReport report = world.step(kDt_s, kSubsteps);
    const Vec3 residual = world.momentum() - before - report.external_impulse_Ns;
    EXPECT_LT(residual.norm(), 2e-3) << "step " << i;  // The ball alone has 1,200 N s.
  }
}

TEST(Sleep, APausedBodyFallsAsleepUnderAMovingOne) {
  RigidWorld world;
  world.add(W::ground());
  const BodyId plate = world.add(W::box(Vec3(2, 0.2, 2), Vec3(0, 0.1, 0), 100));
  BodyDesc top = W::with_friction(W::sphere(0.3, Vec3(0, 0.5, 0), 5000), 0);
  top.angular_velocity_W = Vec3(0, 20, 0);
  const BodyId spinning = world.add(top);
  world.run(0.25, kDt_s, kSubsteps);
  ASSERT_FALSE(world.state(plate).asleep);
  for (int i = 0; i < 180; ++i) {
    world.physics().pause(std::span(&plate, 1));
    world.step(kDt_s, kSubsteps);
  }
  EXPECT_FALSE(world.state(spinning).asleep);
  EXPECT_TRUE(world.state(plate).asleep) << "woken by an unchanged load";
}

TEST(Sleep, GivesTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int count : {1, 2, 4, 7}) {
    set_threads(count);
    RigidWorld world;
    world.add(W::ground());
    const std::vector<BodyId> wall = add_wall(world, 20, 15);
    world.run(2, kDt_s, kSubsteps);
    world.remove(wall[7]);
    BodyDesc ball = W::sphere(0.2, Vec3(2.1, 1.3, -2), 7000);
    ball.velocity_W = Vec3(0, 0, 10);
    world.add(ball);
    world.run(2, kDt_s, kSubsteps);
    hashes.push_back(world.hash());
  }
  set_threads(0);
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace sunder::solver::sleep_test
