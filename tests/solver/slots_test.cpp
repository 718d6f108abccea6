// Tests that nothing is left in a slot of what was there before.
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "solver/rigid/collide/narrow_phase.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver::slots_test {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;
constexpr int kSubsteps = 4;

/// Returns true if the contact of two bodies that touch counts as one of two balls, in a manifold
/// that was of two balls before if `before`.
bool is_ball_pair(const BodyDesc& a, const BodyDesc& b, bool before) {
  Bodies bodies;
  Shapes shapes;
  Pair pair;
  pair.body_a = bodies.add(a), pair.body_b = bodies.add(b);
  const NewShape added[] = {{&a.shapes[0], pair.body_a}, {&b.shapes[0], pair.body_b}};
  const std::vector<ShapeSlot> slots = shapes.add(added, bodies);
  pair.shape_a = slots[0], pair.shape_b = slots[1];
  Manifold m;
  m.is_ball_pair = before;
  NarrowScratch scratch;
  update_contact(StepContext(Vec3(0, -kG, 0), kDt_s), shapes, bodies, pair, m, scratch);
  EXPECT_GT(m.count, 0);
  return m.is_ball_pair;
}

TEST(Slots, AContactIsOfTwoBallsOnlyIfBothBodiesAre) {
  const BodyDesc ground = W::ground(), box = W::box(Vec3(2, 1, 2), Vec3(0, 0.5, 0)),
                 brick = W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)),
                 low_ball = W::sphere(0.5, Vec3(0, 0.5, 0)), ball = W::sphere(0.5, Vec3(0, 1.5, 0));
  for (const bool before : {false, true}) {
    EXPECT_FALSE(is_ball_pair(ground, box, before));
    EXPECT_FALSE(is_ball_pair(ground, low_ball, before));
    EXPECT_FALSE(is_ball_pair(box, brick, before));
    EXPECT_FALSE(is_ball_pair(box, ball, before));
    EXPECT_TRUE(is_ball_pair(low_ball, ball, before));
  }
}

TEST(Slots, KinematicBodiesInTheSlotsOfADenseClusterReachNoLimit) {
  RigidWorld world(awake(Vec3::Zero()));
  std::vector<BodyId> cluster;
  for (int i = 0; i < 100; ++i)
    cluster.push_back(world.add(W::box(Vec3(1, 1, 1), Vec3(0.001 * i, 0, 0))));
  EXPECT_EQ(world.step(kDt_s, kSubsteps).limits[Limit::kDenseClusters], 1u);
  std::vector<BodyDesc> plates;
  for (int i = 0; i < 100; ++i) {
    plates.push_back(W::box(Vec3(1, 1, 1), Vec3(2 * i, 0, 0)));
    plates.back().is_kinematic = true;
  }
  world.replace(cluster, plates);
  world.step(kDt_s, kSubsteps);
  EXPECT_EQ(world.step(kDt_s, kSubsteps).limits[Limit::kDenseClusters], 0u);
}

TEST(Slots, ABodyInTheSlotOfAPausedOneMoves) {
  RigidWorld world(awake(Vec3::Zero()));
  const BodyId paused = world.add(W::moving(W::sphere(0.1, Vec3::Zero()), Vec3(1, 0, 0)));
  world.physics().collide(kDt_s);
  world.physics().pause(std::span(&paused, 1));
  const BodyId next =
      world.replace({paused}, {W::moving(W::sphere(0.1, Vec3::Zero()), Vec3(2, 0, 0))}).front();
  world.physics().solve(kDt_s, kSubsteps);
  EXPECT_NEAR(world.state(next).X_WB.position.x(), 2 * kDt_s, 1e-9);
}

}  // namespace
}  // namespace sunder::solver::slots_test
