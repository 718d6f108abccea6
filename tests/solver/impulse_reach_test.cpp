// Tests that bodies at rest take an impact as in a world without sleep: momentum is kept through
// rows, stacks, crates, cradles and joints, and no more is woken than an impact can move.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fixtures/piles.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver::impulse_reach_test {
namespace {

using W = RigidWorld;

RigidOptions options_of(const Preset& preset, bool sleeping) {
  RigidOptions options = solver::options_of(preset);
  options.sleeping = sleeping;
  return options;
}

/// A ball that strikes bodies at rest.
struct Striker {
  double radius_m, density_kg_m3, speed_m_s;
};
constexpr Striker kStrikers[] = {{0.1, 2000, 4}, {0.1, 20000, 3}, {0.06, 9000, 12}};

struct Outcome {
  Vec3 momentum_Ns = Vec3::Zero();  ///< Of all bodies.
  double kinetic_J = 0;
  double striker_Ns = 0;  ///< Momentum before the impact.
};

using AddBodies = std::function<std::vector<BodyId>(RigidWorld&)>;

/// Returns momentum and energy of a world `time_s` after a ball that flies along x from `from_W`
/// was added to bodies that had come to rest.
Outcome strike(const Preset& preset, bool sleeping, const AddBodies& add, const Striker& striker,
               const Vec3& from_W, double time_s) {
  RigidWorld world(options_of(preset, sleeping));
  const std::vector<BodyId> bodies = add(world);
  world.run(3, preset.dt_s, preset.substeps);
  for (const BodyId id : bodies) EXPECT_EQ(world.state(id).asleep, sleeping);
  const BodyDesc ball = W::with_friction(
      W::moving(
          W::sphere(striker.radius_m, from_W - Vec3(striker.radius_m, 0, 0), striker.density_kg_m3),
          Vec3(striker.speed_m_s, 0, 0)),
      0);
  world.add(ball);
  world.run(time_s, preset.dt_s, preset.substeps);
  return {world.momentum(), world.kinetic_energy(), ball.mass_kg * striker.speed_m_s};
}

void expect_equal_impacts(const Preset& preset, const AddBodies& add, const Striker& striker,
                          const Vec3& from_W, double time_s) {
  const Outcome awake = strike(preset, false, add, striker, from_W, time_s);
  const Outcome asleep = strike(preset, true, add, striker, from_W, time_s);
  EXPECT_NEAR(awake.momentum_Ns.x(), awake.striker_Ns, 0.01 * awake.striker_Ns);
  EXPECT_NEAR(asleep.momentum_Ns.x(), awake.striker_Ns, 0.01 * awake.striker_Ns);
  EXPECT_NEAR(asleep.kinetic_J, awake.kinetic_J, 0.02 * awake.kinetic_J);
}

/// Adds boxes of 16 kg on a ground without friction, in `rows` layers.
std::vector<BodyId> add_row(RigidWorld& world, int count, int layers, double friction) {
  world.add(W::with_friction(W::ground(), 0));
  std::vector<BodyId> boxes;
  for (int layer = 0; layer < layers; ++layer)
    for (int i = 0; i < count; ++i)
      boxes.push_back(world.add(W::with_friction(
          W::box(Vec3(0.2, 0.2, 0.2), Vec3(0.2 * i, 0.1 + 0.2 * layer, 0), 2000), friction)));
  return boxes;
}

TEST(ImpulseReach, RowsAtRestTakeAnImpactAsAwakeOnes) {
  for (const Preset& preset : kPresets) {
    for (const Striker& striker : kStrikers) {
      for (const int count : {2, 3, 5, 8, 13, 20}) {
        SCOPED_TRACE(std::string(preset.name) + ", " + std::to_string(count) + " boxes, " +
                     std::to_string(striker.speed_m_s) + " m/s");
        const auto add = [&](RigidWorld& world) { return add_row(world, count, 1, 0); };
        expect_equal_impacts(preset, add, striker, Vec3(-0.3, 0.1, 0), 0.4);
      }
    }
  }
}

TEST(ImpulseReach, RowsOfStacksAtRestKeepTheMomentumOfAnImpact) {
  for (const Preset& preset : kPresets) {
    for (const int count : {1, 3, 8}) {
      SCOPED_TRACE(std::string(preset.name) + ", " + std::to_string(count) + " stacks");
      const auto add = [&](RigidWorld& world) { return add_row(world, count, 3, 0.5); };
      const Outcome asleep = strike(preset, true, add, kStrikers[0], Vec3(-0.3, 0.3, 0), 0.2);
      EXPECT_NEAR(asleep.momentum_Ns.x(), asleep.striker_Ns, 0.01 * asleep.striker_Ns);
    }
  }
}

/// Adds 4 × 3 crates in a block.
std::vector<BodyId> add_crates(RigidWorld& world) {
  world.add(W::with_friction(W::ground(), 0));
  std::vector<BodyId> crates;
  for (int i = 0; i < 12; ++i)
    crates.push_back(
        world.add(W::box(Vec3(0.5, 0.4, 0.5), Vec3(0.5 * (i % 4), 0.2, 0.5 * (i / 4 - 1)), 300)));
  return crates;
}

TEST(ImpulseReach, CratesAtRestKeepTheMomentumOfAnImpact) {
  for (const Preset& preset : kPresets) {
    for (const double aside_m : {0.0, 0.12, 0.25}) {
      SCOPED_TRACE(std::string(preset.name) + ", " + std::to_string(aside_m) + " m aside");
      const Outcome asleep =
          strike(preset, true, add_crates, {0.2, 2000, 5}, Vec3(-0.5, 0.2, aside_m), 0.2);
      EXPECT_NEAR(asleep.momentum_Ns.x(), asleep.striker_Ns, 0.01 * asleep.striker_Ns);
    }
  }
}

TEST(ImpulseReach, ACradleAtRestKeepsTheMomentumOfAnImpact) {
  for (const Preset& preset : kPresets) {
    for (const int count : {2, 5, 10}) {
      SCOPED_TRACE(std::string(preset.name) + ", " + std::to_string(count) + " balls");
      RigidWorld world(options_of(preset, true));
      std::vector<BodyId> balls;
      for (int i = 0; i < count; ++i) {
        balls.push_back(world.add(W::sphere(0.1, Vec3(0.2 * i, 0, 0), 7800)));
        world.physics().join(
            joint_at(world, JointKind::kBall, {}, balls.back(), Vec3(0.2 * i, 20, 0)));
      }
      world.run(3, preset.dt_s, preset.substeps);
      for (const BodyId id : balls) EXPECT_TRUE(world.state(id).asleep);
      const BodyDesc ball = W::moving(W::sphere(0.1, Vec3(-0.25, 0, 0), 7800), Vec3(2, 0, 0));
      world.add(ball);
      const double before_Ns = 2 * ball.mass_kg;
      world.run(0.1, preset.dt_s, preset.substeps);
      EXPECT_NEAR(world.momentum().x(), before_Ns, 0.01 * before_Ns);
    }
  }
}

TEST(ImpulseReach, AnImpactPassesThroughJointsToWhatTheBodiesBehindThemTouch) {
  for (const Preset& preset : kPresets) {
    SCOPED_TRACE(preset.name);
    const auto add = [](RigidWorld& world) {
      std::vector<BodyId> boxes = add_row(world, 3, 1, 0);
      // A gap between the third and the fourth box, and a joint across it.
      for (const int i : {3, 4})
        boxes.push_back(world.add(
            W::with_friction(W::box(Vec3(0.2, 0.2, 0.2), Vec3(0.1 + 0.2 * i, 0.1, 0), 2000), 0)));
      world.physics().join(
          joint_at(world, JointKind::kFixed, boxes[2], boxes[3], Vec3(0.55, 0.1, 0)));
      return boxes;
    };
    expect_equal_impacts(preset, add, kStrikers[0], Vec3(-0.3, 0.1, 0), 0.4);
  }
}

TEST(ImpulseReach, APebbleWakesNoPile) {
  RigidWorld world;
  world.add(W::ground());
  std::vector<BodyId> pile;
  for (const BodyDesc& box : boxes_of({150, 5, 0.4, 0.15, 4})) pile.push_back(world.add(box));
  const Preset& preset = kPresets[1];
  world.run(10, preset.dt_s, preset.substeps);
  const auto awake = [&] {
    return std::ranges::count_if(pile, [&](BodyId id) { return !world.state(id).asleep; });
  };
  ASSERT_EQ(awake(), 0);
  world.add(W::moving(W::sphere(0.03, Vec3(0.8, 3, 0.8), 2000), Vec3(0, -3, 0)));
  std::ptrdiff_t most = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(preset.dt_s, preset.substeps);
    most = std::max(most, awake());
  }
  EXPECT_GE(most, 1);
  EXPECT_LE(most, 8);
}

}  // namespace
}  // namespace sunder::solver::impulse_reach_test
