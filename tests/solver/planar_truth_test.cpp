// Our solver in three dimensions against Box2D in two (notes: truth 25): what stands in one stands
// in the other, and comes to rest in the same place. Each prints its error per preset.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>

#include "solver/planar/planar_physics.h"
#include "bench/truths/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
using Build = std::function<void(RigidWorld&)>;

/// Where everything is after some seconds.
struct Rest {
  std::vector<BodyState> states;
  double highest_m = 0;
};

Rest settle(RigidWorld world, const Build& build, double dt_s, int substeps) {
  build(world);
  world.run(4, dt_s, substeps);
  Rest rest;
  for (std::size_t i = 0; i < world.size(); ++i) {
    rest.states.push_back(world.state(world.id(i)));
    rest.highest_m = std::max(rest.highest_m, rest.states.back().X_WB.position.y());
  }
  return rest;
}

Rest planar_rest(const Build& build, double block_m) {
  PlanarOptions options;
  options.piece_m = block_m;
  options.sleeping = false;
  return settle(RigidWorld(make_planar_physics(options)), build, 1.0 / 120, 4);
}

Rest solid_rest(const Build& build, const Preset& preset) {
  return settle(RigidWorld(awake(preset)), build, preset.dt_s, preset.substeps);
}

/// The furthest that a block is from where Box2D leaves it, in blocks; a turn moves its corners.
double largest_difference(const Rest& a, const Rest& b, double block_m) {
  double largest = 0;
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    const Pose &x = a.states[i].X_WB, &y = b.states[i].X_WB;
    const double turn = 2 * (x.rotation.conjugate() * y.rotation).vec().norm();
    largest = std::max(largest, (x.position - y.position).norm() / block_m + 0.5 * turn);
  }
  return largest;
}

void expect_same_rest(const char* what, const Build& build, double block_m) {
  const Rest truth = planar_rest(build, block_m);
  std::printf("%-44s", what);
  for (const Preset& preset : kPresets) {
    const double error = largest_difference(solid_rest(build, preset), truth, block_m);
    std::printf("  %s %.2g", preset.name, error);
    if (&preset >= &kPresets[2]) {
      EXPECT_LT(error, 0.01) << what << ", " << preset.name;
    }
  }
  std::printf("\n");
}

void build_wall(RigidWorld& world) {
  world.add(W::ground());
  for (int row = 0; row < 8; ++row)
    for (int i = 0; i < 6; ++i)
      world.add(W::box(Vec3(0.4, 0.2, 0.2), Vec3((i + 0.4 * (row % 2)) * 0.4, 0.2 * row + 0.1, 0)));
}

void build_pyramid(RigidWorld& world) {
  world.add(W::ground());
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10 - row; ++i)
      world.add(W::box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0)));
}

/// A semicircle of `count` stones about a circle of radius 1, `slim` thick.
void build_arch(RigidWorld& world, int count, double slim) {
  world.add(W::with_friction(W::ground(), 1));
  for (int i = 0; i < count; ++i) world.add(W::voussoir(i, count, slim));
}

/// Four bricks, each beyond the next by `factor` times what just balances.
void build_overhang(RigidWorld& world, double factor) {
  world.add(W::ground());
  world.add(W::fixed(W::box(Vec3(1, 1, 0.5), Vec3(0, 0.5, 0))));
  double x = 0;
  for (int level = 1; level <= 4; ++level) {
    x += factor * 0.5 / (5 - level);
    world.add(W::box(Vec3(1, 0.2, 0.5), Vec3(x, 0.9 + 0.2 * level, 0)));
  }
}

TEST(PlanarTruth, AWallRestsWhereBox2dLeavesIt) {
  expect_same_rest("wall of 48, from Box2D in bricks (mark .01)", build_wall, 0.4);
}

TEST(PlanarTruth, APyramidRestsWhereBox2dLeavesIt) {
  expect_same_rest("pyramid of 55, from Box2D in boxes (mark .01)", build_pyramid, 1);
}

TEST(PlanarTruth, AnArchRestsWhereBox2dLeavesIt) {
  expect_same_rest(
      "arch of 11, from Box2D in stones (mark .01)",
      [](RigidWorld& world) { build_arch(world, 11, 0.14); }, 0.28);
}

/// Whether both lose height, or neither; `draft` and `realtime` may be too soft to say.
void expect_same_verdict(const char* what, const Build& build, double block_m, double start_m,
                         bool falls) {
  const auto fell = [&](const Rest& rest) { return rest.highest_m < start_m - 0.05; };
  EXPECT_EQ(fell(planar_rest(build, block_m)), falls) << what << ", Box2D";
  std::printf("%-44s", what);
  for (const Preset& preset : kPresets) {
    const bool fell_here = fell(solid_rest(build, preset));
    std::printf("  %s %s", preset.name, fell_here ? "falls" : "stands");
    if (&preset >= &kPresets[2]) {
      EXPECT_EQ(fell_here, falls) << what << ", " << preset.name;
    }
  }
  std::printf("\n");
}

TEST(PlanarTruth, ArchesStandOrFallInBoth) {
  for (const auto& [slim, falls] : {std::pair{0.09, true}, {0.125, false}})
    expect_same_verdict(
        falls ? "thin arch (falls)" : "thick arch (stands)",
        [slim = slim](RigidWorld& world) { build_arch(world, 11, slim); }, 0.28, 1, falls);
}

TEST(PlanarTruth, OverhangsStandOrFallInBoth) {
  for (const auto& [factor, falls] : {std::pair{0.96, false}, {1.03, true}})
    expect_same_verdict(
        falls ? "far overhang (falls)" : "near overhang (stands)",
        [factor = factor](RigidWorld& world) { build_overhang(world, factor); }, 0.5, 1.7, falls);
}

}  // namespace
}  // namespace sunder::solver
