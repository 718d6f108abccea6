// Symptom: two bodies that met off-centre at 3 m/s lost some hundredths of their angular momentum.
// Cause: the two lever arms of a contact were computed when the step began, and ended at two points
// as soon as the bodies moved; opposite impulses at two points add a torque. Fixed in dc4d495.
#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressContact, BodiesThatMeetOffCentreKeepTheirAngularMomentum) {
  RigidWorld world(awake(Vec3::Zero()));
  const Quat leaning(Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()));
  BodyDesc a = W::moving(W::box(Vec3(0.4, 0.3, 0.2), Vec3(-0.5, 0, 0)), Vec3(3, 0.2, 0));
  a.X_WB.rotation = leaning;
  world.add(W::with_friction(a, 0.5));
  world.add(W::with_friction(W::box(Vec3(0.3, 0.5, 0.3), Vec3(0, 0.2, 0.1)), 0.5));
  const Vec3 before = world.angular_momentum();
  const double scale = world.momentum().norm() * 0.2;  // momentum times offset in m
  bool met = false;
  for (int i = 0; i < 60; ++i) met |= world.step(1.0 / 60, 4).contacts > 0;
  EXPECT_TRUE(met);
  EXPECT_LT((world.angular_momentum() - before).norm(), 1e-3 * scale);
}

}  // namespace
}  // namespace sunder::solver
