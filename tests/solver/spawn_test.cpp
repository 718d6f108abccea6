// Tests of the contacts of many bodies that are added side by side.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(Spawn, CubesOfAGridTouchInFacesOnly) {
  RigidOptions options;
  options.sleeping = false;
  RigidWorld world(options);
  constexpr int kSide = 4;
  std::vector<BodyDesc> cubes = {W::ground()};
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Vec3 cell(i % kSide, i / kSide / kSide + 0.5, i / kSide % kSide);
    cubes.push_back(W::box(Vec3(0.2, 0.2, 0.2), 0.2 * cell));
  }
  world.replace({}, cubes);
  constexpr int kFaces = 3 * kSide * kSide * (kSide - 1) + kSide * kSide;
  EXPECT_EQ(world.step(1.0 / 60, 8).contacts, kFaces);
  EXPECT_EQ(world.run(1, 1.0 / 60, 8).contacts, kFaces);
}

TEST(Spawn, CubesThatMeetAtAnEdgeCollideBeforeTheyOverlap) {
  for (const double speed_m_s : {0.001, 0.01, 1.0}) {
    RigidOptions options;
    options.gravity_W = Vec3::Zero();
    options.sleeping = false;
    RigidWorld world(options);
    const Vec3 side(0.2, 0.2, 0.2), velocity = Vec3(1, 1, 0) * speed_m_s;
    const BodyId struck = world.add(W::box(side, Vec3(0, 0, 0)));
    BodyDesc mover = W::box(side, Vec3(-0.2, -0.2, 0));
    mover.velocity_W = velocity;
    world.add(mover);
    double most_m = 0;
    for (int i = 0; i < 120; ++i) {
      world.step(1.0 / 60, 4);
      for (const float depth_m : world.physics().penetrations())
        most_m = std::max(most_m, static_cast<double>(depth_m));
    }
    EXPECT_LT(most_m, 1.15e-3) << speed_m_s;
    EXPECT_GT(world.state(struck).velocity_W.norm(), 0.3 * speed_m_s) << speed_m_s;
  }
}

}  // namespace
}  // namespace sunder::solver
