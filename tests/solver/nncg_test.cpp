// Tests that conjugate gradients (NNCG) need far fewer sweeps than plain Gauss-Seidel.
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::nncg_test {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81, kDt_s = 1.0 / 240;

RigidOptions with_sweeps(int sweeps, bool accelerated) {
  RigidOptions options;
  options.sleeping = false;
  options.sweeps = sweeps;
  options.accelerated = accelerated;
  return options;
}

/// Returns the fraction of the weight of a stack of 50 boxes that the ground does not bear after
/// one step of `sweeps` sweeps without warm start.
double residual(int sweeps, bool accelerated) {
  RigidOptions options = with_sweeps(sweeps, accelerated);
  options.static_warm_start = 0;
  RigidWorld world(options);
  world.add(W::ground());
  for (int i = 0; i < 50; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0)));
  world.step(kDt_s, 1);
  const double weight_Ns = 50 * 1000 * kG * kDt_s;
  return world.momentum().norm() / weight_Ns;
}

/// Returns the first number of sweeps, growing by an eighth, whose residual is at most `limit`.
int sweeps_to(double limit, bool accelerated) {
  int sweeps = 8;
  while (sweeps < 16384 && residual(sweeps, accelerated) > limit) sweeps += sweeps / 8;
  return sweeps;
}

TEST(Nncg, ReachesTheSolutionOfAStackInATenthOfTheSweeps) {
  for (const int sweeps : {16, 32, 64, 128, 256, 512}) {
    std::printf("stack of 50, %4d sweeps: residual %.1e plain, %.1e by conjugate gradients\n",
                sweeps, residual(sweeps, false), residual(sweeps, true));
  }
  const int plain = sweeps_to(0.01, false), accelerated = sweeps_to(0.01, true);
  std::printf("to 1 %%: %d plain, %d by conjugate gradients, %.1f times fewer\n", plain,
              accelerated, 1.0 * plain / accelerated);
  EXPECT_GE(plain, 10 * accelerated);
}

TEST(Nncg, SlidesAsFarAsPlainSweeps) {
  double travel[2];
  for (const bool accelerated : {false, true}) {
    RigidWorld world(with_sweeps(8, accelerated));
    world.add(W::with_friction(W::ground(), 0.4));
    BodyDesc desc = W::with_friction(W::box(Vec3(1, 0.2, 1), Vec3(0, 0.1, 0)), 0.4);
    desc.velocity_W = Vec3(3, 0, 0);
    const BodyId body = world.add(desc);
    world.run(2, 1.0 / 120, 4);
    travel[accelerated] = world.state(body).X_WB.position.x();
  }
  EXPECT_NEAR(travel[1] / travel[0], 1, 1e-3);
}

TEST(Nncg, GivesTheSameBitsForAnyNumberOfThreadsAndLanes) {
  std::uint64_t hashes[4];
  const int before = threads();
  for (int run = 0; run < 4; ++run) {
    set_threads(run < 2 ? 1 + 2 * run : 2);
    RigidOptions options = with_sweeps(6, true);
    options.lanes = run < 2 ? 0 : run == 2 ? 1 : 4;
    RigidWorld world(options);
    world.add(W::ground());
    for (int i = 0; i < 200; ++i) {
      const Vec3 at(i % 6 + 0.1 * (i % 7), 0.6 + 1.1 * (i / 36), (i / 6) % 6 + 0.1 * (i % 5));
      world.add(W::box(Vec3(0.9, 0.9, 0.9), at));
    }
    world.run(0.5, 1.0 / 120, 4);
    hashes[run] = world.hash();
  }
  set_threads(before);
  for (int run = 1; run < 4; ++run) EXPECT_EQ(hashes[0], hashes[run]) << run;
}

}  // namespace
}  // namespace sunder::solver::nncg_test
