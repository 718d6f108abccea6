// Symptom: chips stayed in the air where a wall had lost the convex that they lay on. Cause:
// sleeping debris checked only that the body under it existed and had not moved, but a break that
// removes a part of a body leaves the body in place. Fixed in bb0aa35.
#include <gtest/gtest.h>

#include "solver/particles/debris.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver {
namespace {

constexpr double kDt = 1.0 / 120;

void run(Debris& debris, TestObstacles& obstacles, double seconds) {
  for (int step = 0; step < seconds / kDt; ++step) debris.advance(kDt, obstacles.view());
}

TEST(RegressDebris, FallsWhenTheConvexUnderItIsRemovedFromItsBody) {
  Debris debris(10, Vec3(0, -9.81, 0));
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0, 2, 0), Vec3(1, 0.1, 1), Quat::Identity());
  DebrisBirth chip;
  chip.position_W = Vec3f(0, 2.2f, 0);
  chip.radius_m = 0.02f;
  debris.add(chip);
  run(debris, obstacles, 2);
  ASSERT_EQ(debris.counts().awake, 0u);
  obstacles.shapes.clear();  // the body's other shapes are elsewhere
  run(debris, obstacles, 0.2);
  EXPECT_EQ(debris.counts().awake, 0u) << "the number of edits has not changed";
  ++obstacles.bodies[0].edits;
  run(debris, obstacles, 3);
  EXPECT_NEAR(debris.view().position_W[0].y(), 0.02, 1e-3);
}

}  // namespace
}  // namespace sunder::solver
