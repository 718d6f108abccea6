// Symptom: a cube that fell flat on the ground with restitution left it spinning at 4 rad/s. Cause:
// restitution was applied after the last substep, to one corner after another. Fixed in 87c9a90:
// restitution is applied before the sweeps, to all points of a contact at once.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressRebound, ACubeThatFallsFlatReboundsWithoutSpin) {
  const double restitution = 0.6, fall_m = 1, g_m_s2 = 9.81;
  RigidWorld world;
  world.add(W::with_friction(W::ground(), 0.5, restitution));
  const BodyId cube =
      world.add(W::with_friction(W::box(Vec3::Ones(), Vec3(0, 0.5 + fall_m, 0)), 0.5, restitution));
  double fastest_rad_s = 0, highest_m = 0;
  const double meets_s = std::sqrt(2 * fall_m / g_m_s2);
  for (int i = 0; i < 60; ++i) {
    world.step(1.0 / 60, 4);
    const BodyState state = world.state(cube);
    fastest_rad_s = std::max(fastest_rad_s, state.angular_velocity_W.norm());
    if (i > 60 * meets_s + 1) highest_m = std::max(highest_m, state.X_WB.position.y() - 0.5);
  }
  EXPECT_LT(fastest_rad_s, 1e-3);
  EXPECT_NEAR(highest_m, restitution * restitution * fall_m, 2e-3);
}

}  // namespace
}  // namespace sunder::solver
