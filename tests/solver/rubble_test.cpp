// Tests of rubble: penetration at rest, remaining speed, and time until sleep.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/geometry/hull.h"
#include "solver/rigid/collide/patch.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::rubble_test {
namespace {

using W = RigidWorld;

constexpr double kDt_s = 1.0 / 60;
constexpr int kSubsteps = 8;
constexpr std::size_t kWalls = 5;

/// Adds 300 hulls of 10 to 50 cm above a pit; the mass ratio is up to 500.
void add_rubble(RigidWorld& world, std::uint64_t seed) {
  constexpr double kPitch_m = 0.45, kHalf_m = 1.425;  // The values of `solver_bench piles`.
  world.add(W::ground());
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    BodyDesc wall = W::ground(normal);
    wall.X_WB.position = -kHalf_m * normal;
    world.add(wall);
  }
  Random random(seed);
  for (int i = 0; i < 300; ++i) {
    const double size = random.uniform(0.1, 0.5);
    std::vector<Vec3> points(8 + random.below(9));
    for (Vec3& point : points) point = 0.5 * size * random.direction();
    const Vec3 cell(i % 5 - 2, i / 25, i / 5 % 5 - 2);
    // One statement per component fixes the order of the random numbers for every compiler.
    Vec3 jitter(0, 0.4, 0);
    jitter.x() = random.uniform(-0.05, 0.05);
    jitter.z() = random.uniform(-0.05, 0.05);
    world.add(W::hull(make_hull(points), kPitch_m * cell + jitter, 2000));
  }
}

struct Depth {
  double mean_m = 0, max_m = 0;
};

Depth depth_of(RigidWorld& world) {
  Depth depth;
  const std::vector<float> depths = world.physics().penetrations();
  for (const float d : depths) {
    depth.mean_m += double{d} / static_cast<double>(depths.size());
    depth.max_m = std::max(depth.max_m, double{d});
  }
  return depth;
}

double rms_speed(const RigidWorld& world) {
  double square = 0;
  for (std::size_t i = kWalls; i < world.size(); ++i)
    square += world.state(world.id(i)).velocity_W.squaredNorm();
  return std::sqrt(square / static_cast<double>(world.size() - kWalls));
}

double share_asleep(const RigidWorld& world) {
  double asleep = 0;
  for (std::size_t i = kWalls; i < world.size(); ++i) asleep += world.state(world.id(i)).asleep;
  return asleep / static_cast<double>(world.size() - kWalls);
}

RigidOptions without_sleep() {
  RigidOptions options;
  options.sleeping = false;
  return options;
}

// The deepest contact of one pile varies from 1 to 6 mm, so the mean over piles is tested too.
TEST(Rubble, AtRestPenetratesByAFewMillimetresAndDoesNotMove) {
  constexpr int kPiles = 3;
  double max_m = 0;
  for (std::uint64_t seed = 1; seed <= kPiles; ++seed) {
    RigidWorld world(without_sleep());
    add_rubble(world, seed);
    world.run(10, kDt_s, kSubsteps);
    const Depth depth = depth_of(world);
    std::printf("300 hulls: %.3f mm deep, %.2f mm at most, rms speed %.1e m/s\n",
                1e3 * depth.mean_m, 1e3 * depth.max_m, rms_speed(world));
    EXPECT_LT(depth.mean_m, 0.2e-3);
    EXPECT_LT(depth.max_m, 5e-3);
    EXPECT_LT(rms_speed(world), 1e-4);
    max_m += depth.max_m / kPiles;
  }
  EXPECT_LT(max_m, 4e-3);
}

// The deepest contact of a pile varies by chance, so the sums over several piles are compared.
TEST(Rubble, SleepsWithinThreeSecondsOfRestWithoutMorePenetration) {
  Depth allowed, depth;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    RigidWorld awake(without_sleep()), world;
    add_rubble(awake, seed);
    add_rubble(world, seed);
    double rest_s = 0;
    for (; rest_s < 10 && (rest_s < 1 || rms_speed(awake) > 0.01); rest_s += kDt_s) {
      awake.step(kDt_s, kSubsteps);
      world.step(kDt_s, kSubsteps);
    }
    awake.run(3, kDt_s, kSubsteps);
    world.run(3, kDt_s, kSubsteps);
    const Depth of_awake = depth_of(awake), of_asleep = depth_of(world);
    std::printf(
        "300 hulls at rest after %.1f s, 3 s later %.1f %% asleep; %.3f mm deep, %.2f mm at "
        "most, awake %.3f and %.2f mm\n",
        rest_s, 100 * share_asleep(world), 1e3 * of_asleep.mean_m, 1e3 * of_asleep.max_m,
        1e3 * of_awake.mean_m, 1e3 * of_awake.max_m);
    EXPECT_LT(rest_s, 10);
    EXPECT_GT(share_asleep(world), 0.9);
    EXPECT_LT(of_asleep.mean_m, 1.1 * of_awake.mean_m);
    depth.max_m += of_asleep.max_m;
    allowed.max_m += of_awake.max_m;
  }
  EXPECT_LT(depth.max_m, 1.2 * allowed.max_m);
}

// The slab rests on pebbles only; contacts of the usual stiffness would throw it up forever.
TEST(Rubble, ASlabOnPebblesAloneComesToRest) {
  constexpr double kPebble_m = 0.06, kDrop_m = 0.005;
  RigidWorld world(without_sleep());
  world.add(W::ground());
  for (const Vec3& at : {Vec3(0, 0, 0.25), Vec3(-0.2, 0, -0.15), Vec3(0.2, 0, -0.15)})
    world.add(W::box(kPebble_m * Vec3(1, 1, 1), at + 0.5 * kPebble_m * Vec3::UnitY(), 2000));
  const BodyId slab =
      world.add(W::box(Vec3(0.8, 0.1, 0.8), Vec3(0, kPebble_m + kDrop_m + 0.05, 0), 2000));
  for (const int x : {-1, 1})
    for (const int z : {-1, 1})
      world.add(W::box(Vec3(0.35, 0.2, 0.35), Vec3(0.2 * x, kPebble_m + 2 * kDrop_m + 0.2, 0.2 * z),
                       2000));
  world.run(10, kDt_s, kSubsteps);
  const Depth depth = depth_of(world);
  std::printf("slab on pebbles: %.2f mm at most, speed %.1e m/s\n", 1e3 * depth.max_m,
              world.state(slab).velocity_W.norm());
  EXPECT_LT(world.state(slab).velocity_W.norm(), 1e-4);
  EXPECT_LT(depth.max_m, 6e-3);  // 9.8 mm with the stiffness that follows from the pebbles' mass.
}

// A stone on three corners; the fourth point is far above the ground but spans the largest area.
TEST(Rubble, ReducingAManifoldKeepsTheDeepestPointsBeforeTheWidest) {
  const auto point = [](double x, double z, double separation, std::uint32_t feature) {
    const Vec3f at(static_cast<float>(x), 0, static_cast<float>(z));
    return PatchPoint{at, at, static_cast<float>(separation), feature};
  };
  std::vector<PatchPoint> points = {
      point(-55.8e-3, -29.2e-3, -0.185e-3, 0), point(16.5e-3, -54.8e-3, 3.561e-3, 4),
      point(54e-3, -9.2e-3, -0.251e-3, 7), point(-5.8e-3, 65.4e-3, 0.803e-3, 9),
      point(31e-3, 52.8e-3, -0.258e-3, 12)};
  reduce_patch(Vec3f::UnitY(), 0.8e-3f, points);
  std::vector<std::uint32_t> kept;
  for (const PatchPoint& p : points) kept.push_back(p.feature);
  EXPECT_EQ(kept, (std::vector<std::uint32_t>{0, 7, 9, 12}));
}

}  // namespace
}  // namespace sunder::solver::rubble_test
