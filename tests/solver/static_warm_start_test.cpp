// Tests of new contacts under load: breaks at rest, bodies put on a stack, the start of a scene.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::static_warm_start_test {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81;
constexpr int kBricks = 10;

RigidOptions awake(double warm_start = 1) {
  RigidOptions options;
  options.sleeping = false;
  options.static_warm_start = warm_start;
  return options;
}

/// Adds a tower whose bricks start 1 mm apart, so that its contacts have warm impulses.
std::vector<BodyId> add_tower(RigidWorld& world) {
  world.add(W::ground());
  std::vector<BodyId> bricks;
  for (int i = 0; i < kBricks; ++i)
    bricks.push_back(world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.501 + 1.001 * i, 0))));
  return bricks;
}

/// Replaces every brick by eight pieces at its place, all in one step.
void break_all(const std::vector<BodyId>& bricks, RigidWorld& world) {
  std::vector<BodyDesc> pieces;
  for (const BodyId brick : bricks) {
    const BodyState parent = world.state(brick);
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5);
      const Vec3 arm = parent.X_WB.rotation * Vec3(0.5 * corner);
      BodyDesc piece = W::box(Vec3(0.5, 0.5, 0.5), parent.X_WB.position + arm);
      piece.X_WB.rotation = parent.X_WB.rotation;
      piece.velocity_W = parent.velocity_W + parent.angular_velocity_W.cross(arm);
      piece.angular_velocity_W = parent.angular_velocity_W;
      pieces.push_back(piece);
    }
  }
  world.replace(bricks, pieces);
}

struct BreakFigures {
  double peak_kinetic_J = 0;
  /// Rise of kinetic plus potential energy over the start, relative to the start.
  double max_gain = -1e30;
};

/// Returns figures of the second after all bricks of a tower at rest broke.
BreakFigures break_at_rest(int substeps, double warm_start) {
  RigidWorld world(awake(warm_start));
  const std::vector<BodyId> bricks = add_tower(world);
  world.run(2, 1.0 / 60, substeps);
  const double before_J = world.kinetic_energy() + world.potential_energy(kG);
  break_all(bricks, world);
  BreakFigures after;
  for (int i = 0; i < 60; ++i) {
    world.step(1.0 / 60, substeps);
    const double kinetic_J = world.kinetic_energy();
    after.peak_kinetic_J = std::max(after.peak_kinetic_J, kinetic_J);
    after.max_gain =
        std::max(after.max_gain, (kinetic_J + world.potential_energy(kG) - before_J) / before_J);
  }
  return after;
}

TEST(StaticWarmStart, ATowerAllOfWhoseBricksBreakInOneStepHardlyMoves) {
  for (const int substeps : {4, 8}) {
    const double cold_J = break_at_rest(substeps, 0).peak_kinetic_J;
    const double warm_J = break_at_rest(substeps, 1).peak_kinetic_J;
    std::printf("10 bricks into 8, %d substeps: peak kinetic energy %.3g J, cold %.3g J\n",
                substeps, warm_J, cold_J);
    EXPECT_LT(warm_J, 0.01 * cold_J);
  }
}

TEST(StaticWarmStart, ABreakAtRestGainsNoEnergyAndTheTestDetectsTwiceTheLoad) {
  constexpr double kMost = 1e-6;
  for (const int substeps : {4, 8}) {
    const double gain = break_at_rest(substeps, 1).max_gain;
    const double twice = break_at_rest(substeps, 2).max_gain;
    std::printf("energy gained by a break, %d substeps: %.2g of it; with twice the load %.2g\n",
                substeps, gain, twice);
    EXPECT_LT(gain, kMost);
    EXPECT_GT(twice, 100 * kMost);
  }
}

/// Returns the maximum kinetic energy of a tower of flat bricks after a body is put on it
/// off-centre. If `turned`, the brick's model is rotated, not the brick in the world.
double peak_energy_of_load_J(bool rotated, double warm_start) {
  RigidWorld world(awake(warm_start));
  world.add(W::ground());
  for (int i = 0; i < 4; ++i) {
    BodyDesc brick = W::box(Vec3(2, 0.5, 1), Vec3(0, 0.25 + 0.5 * i, 0));
    if (rotated) {
      brick = W::box(Vec3(0.5, 1, 2), brick.X_WB.position);
      brick.X_WB.rotation = Quat(0.5, 0.5, 0.5, 0.5);  // Maps x to y, y to z, and z to x.
    }
    world.add(brick);
  }
  world.run(1, 1.0 / 60, 8);
  world.add(W::box(Vec3(0.5, 0.5, 0.5), Vec3(0.6, 2.25, 0.1), 4000));
  double most_J = 0;
  for (int i = 0; i < 20; ++i) {
    world.step(1.0 / 60, 8);
    most_J = std::max(most_J, world.kinetic_energy());
  }
  return most_J;
}

TEST(StaticWarmStart, BearsAnOffCentreLoadForAnyRotationOfTheModels) {
  for (const bool rotated : {false, true}) {
    const double cold_J = peak_energy_of_load_J(rotated, 0),
                 warm_J = peak_energy_of_load_J(rotated, 1);
    std::printf("a load off the middle of a tower: %.3g J, cold %.3g J\n", warm_J, cold_J);
    EXPECT_LT(warm_J, 0.15 * cold_J);
  }
}

TEST(StaticWarmStart, BodiesThatFallTogetherHaveNoContactImpulse) {
  RigidWorld world(awake());
  const BodyId low = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 10.5, 0)));
  const BodyId high = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 11.5, 0), 8000));
  world.step(1.0 / 60, 4);
  EXPECT_TRUE(world.physics().penetrations().empty());
  EXPECT_NEAR(world.state(high).velocity_W.y(), -kG / 60, 1e-6);
  EXPECT_NEAR(world.state(low).velocity_W.y(), -kG / 60, 1e-6);
}

TEST(StaticWarmStart, ABodyPutOnAStackAtRestIsSupportedAtOnce) {
  RigidWorld world(awake());
  world.add(W::ground());
  for (int i = 0; i < 5; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0)));
  world.run(1, 1.0 / 60, 8);
  const BodyId top = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 5.5, 0)));
  world.run(1, 1.0 / 60, 8);
  EXPECT_GT(world.state(top).X_WB.position.y(), 5.4985);
  EXPECT_LT(world.kinetic_energy(), 1e-3);
}

TEST(StaticWarmStart, GivesTheSameBitsForAnyNumberOfThreads) {
  std::uint64_t first = 0;
  for (const int count : {1, 2, 3}) {
    set_threads(count);
    RigidWorld world(awake());
    const std::vector<BodyId> bricks = add_tower(world);
    world.run(0.2, 1.0 / 60, 4);
    break_all(bricks, world);
    world.run(0.2, 1.0 / 60, 4);
    if (count == 1) first = world.hash();
    EXPECT_EQ(world.hash(), first);
  }
  set_threads(0);
}

}  // namespace
}  // namespace sunder::solver::static_warm_start_test
