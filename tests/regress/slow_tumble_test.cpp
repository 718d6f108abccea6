// Symptom: a body that tumbled slowly at short steps gradually lost angular momentum. Cause: the
// gyroscopic term was left out below 0.02 rad a step, but its effect adds up over turns, not over
// steps. Fixed in 34ec447.
#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressTumble, KeepsItsAngularMomentumHoweverLittleItTurnsInAStep) {
  RigidWorld world(awake(Vec3::Zero()));
  world.add(W::moving(W::box(Vec3(1, 0.2, 0.5), Vec3::Zero()), Vec3::Zero(), Vec3(1, 2, 0.5)));
  const Vec3 before = world.angular_momentum();
  const double before_J = world.kinetic_energy();
  world.run(2, 1.0 / 240, 4);
  EXPECT_LT((world.angular_momentum() - before).norm(), 1e-6 * before.norm());
  EXPECT_NEAR(world.kinetic_energy(), before_J, 1e-6 * before_J);
}

}  // namespace
}  // namespace sunder::solver
