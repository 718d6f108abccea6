// Symptom: balls that collided off-centre at 500 m/s separated with an error of 1.7 m/s. Cause: the
// normal of their contact was that of the moment when they came within the contact margin, and the
// normal turns until they touch. Fixed in 3a2dde5.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressFlight, BallsThatCollideSeparateAlongTheNormalAtTheirTouch) {
  const double radius_m = 0.05, speed_m_s = 500;
  RigidWorld world(awake(Vec3::Zero()));
  const auto ball = [&](const Vec3& at_W, const Vec3& velocity_W) {
    const BodyDesc resting = W::with_friction(W::sphere(radius_m, at_W), 0);
    return world.add(W::moving(resting, velocity_W));
  };
  // They touch with their centres a radius apart across the motion: normal (cos 30°, sin 30°).
  const BodyId a = ball(Vec3(-2, 0, 0), Vec3(speed_m_s, 0, 0));
  const BodyId b = ball(Vec3(2, radius_m, 0), Vec3(-speed_m_s, 0, 0));
  world.run(0.1, 1.0 / 60, 4);
  const Vec3 normal(std::sqrt(0.75), 0.5, 0);
  const Vec3 change = speed_m_s * normal.x() * normal;  // equal masses, no rebound
  EXPECT_LT((world.state(a).velocity_W - (Vec3(speed_m_s, 0, 0) - change)).norm(), 0.1);
  EXPECT_LT((world.state(b).velocity_W - (Vec3(-speed_m_s, 0, 0) + change)).norm(), 0.1);
}

}  // namespace
}  // namespace sunder::solver
