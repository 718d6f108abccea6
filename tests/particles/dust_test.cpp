// Tests of dust: settling, swirls by its particles' orientation, its grid of air, and its limit.
#include "solver/particles/dust.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "solver/particles/swirl.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver::dust_test {
namespace {

constexpr double kDt = 1.0 / 60;
const Vec3 kGravity(0, -9.81, 0);
const Vec3i kCounts(32, 16, 32);

DustBirth puff_at(const Vec3f& position) {
  DustBirth birth;
  birth.position_W = position;
  birth.mass_kg = 1e-7f;
  birth.settling_m_s = 0.2f;
  return birth;
}

TEST(Dust, SettlesUnderGravityAtItsSpeedAndIsThenRemoved) {
  Dust dust(100, kGravity, kCounts);
  const TestObstacles obstacles;
  for (int i = 0; i < 50; ++i) {
    dust.add(puff_at(Vec3f(0.3f * float(i % 7), 0.8f, 0.3f * float(i / 7))));
  }
  for (int step = 0; step < 60; ++step) dust.advance(kDt, obstacles.view());
  ASSERT_EQ(dust.counts().alive, 50u);
  for (const Vec3f& at : dust.view().position_W) EXPECT_NEAR(at.y(), 0.6, 0.03);
  for (int step = 0; step < 120; ++step) dust.advance(kDt, obstacles.view());
  for (const Vec3f& at : dust.view().position_W) EXPECT_NEAR(at.y(), 0.2, 0.05);
  for (int step = 0; step < 300; ++step) dust.advance(kDt, obstacles.view());
  EXPECT_EQ(dust.counts().alive, 0u);
  EXPECT_EQ(dust.counts().gone, 50u);
}

TEST(Dust, WithoutParticlesHasNoGrid) {
  Dust dust(100, kGravity, kCounts);
  const TestObstacles obstacles;
  dust.advance(kDt, obstacles.view());
  EXPECT_EQ(dust.air(), nullptr);
  dust.add(puff_at(Vec3f(0, 0.001f, 0)));
  dust.advance(kDt, obstacles.view());
  EXPECT_NE(dust.air(), nullptr);
  for (int step = 0; step < 200; ++step) dust.advance(kDt, obstacles.view());
  EXPECT_EQ(dust.counts().alive, 0u);
  EXPECT_EQ(dust.air(), nullptr);
}

TEST(Dust, ThrownIntoAirAtRestAcceleratesTheAir) {
  Dust dust(1000, Vec3::Zero(), kCounts);
  const TestObstacles obstacles;
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 at = 0.3 * random.uniform() * random.direction() + Vec3(0, 1, 0);
    DustBirth birth = puff_at(at.cast<float>());
    birth.velocity_W = Vec3f(5, 0, 0);
    birth.mass_kg = 1e-4f;
    dust.add(birth);
  }
  dust.advance(kDt, obstacles.view());
  EXPECT_GT(dust.air()->velocity(Vec3f(0, 1, 0)).x(), 0.5f);
}

TEST(Dust, IsBlownByAMovingSlabAndStaysOutOfIt) {
  Dust dust(1000, Vec3::Zero(), kCounts);
  TestObstacles obstacles;
  obstacles.set_velocity(obstacles.add_box(Vec3(-0.6, 1, 0), Vec3(0.15, 0.6, 0.6)), Vec3(2, 0, 0));
  for (int i = 0; i < 100; ++i) {
    dust.add(puff_at(Vec3f(0.1f, 0.7f + 0.06f * float(i % 10), -0.3f + 0.06f * float(i / 10))));
  }
  for (int step = 0; step < 30; ++step) {
    obstacles.advance(kDt);
    dust.advance(kDt, obstacles.view());
  }
  const double front = obstacles.bodies[0].X_WB.position.x() + 0.15;
  int ahead = 0;
  for (const Vec3f& at : dust.view().position_W) ahead += double{at.x()} > front - 0.1;
  EXPECT_GE(ahead, 80);
}

TEST(Dust, InsideASolidDoesNotSink) {
  Dust dust(100, kGravity, kCounts);
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0, 5, 0), Vec3(4, 4, 4));
  for (int i = 0; i < 10; ++i) dust.add(puff_at(Vec3f(0.1f * float(i), 5, 0)));
  for (int step = 0; step < 30; ++step) dust.advance(kDt, obstacles.view());
  for (const Vec3f& at : dust.view().position_W) EXPECT_NEAR(at.y(), 5, 0.01);
}

TEST(Dust, KeepsItsGridFineIfAFewParticlesFlyFar) {
  const auto cell_m = [](int strays) {
    Dust dust(1000, kGravity, kCounts);
    for (int i = 0; i < 400; ++i) dust.add(puff_at(Vec3f(0.1f * float(i % 20), 1, 0)));
    for (int i = 0; i < strays; ++i) dust.add(puff_at(Vec3f(100, 1, float(i))));
    dust.advance(kDt, TestObstacles().view());
    EXPECT_FALSE(strays > 0 && dust.air()->contains(Vec3f(100, 1, 0)));
    EXPECT_EQ(dust.air()->velocity(Vec3f(100, 1, 0)), Vec3f::Zero());
    return dust.air()->grid().cell_m;
  };
  EXPECT_EQ(cell_m(8), cell_m(0));
}

TEST(Dust, KeepsItsFlowWhenItsGridIsRefined) {
  Dust dust(4000, Vec3::Zero(), kCounts);
  const TestObstacles obstacles;
  Random random(2);
  const auto add_puffs = [&](int count, const Vec3f& velocity, float mass_kg) {
    for (int i = 0; i < count; ++i) {
      const Vec3 at = 2 * random.uniform() * random.direction() + Vec3(0, 3, 0);
      DustBirth birth = puff_at(at.cast<float>());
      birth.velocity_W = velocity;
      birth.mass_kg = mass_kg;
      dust.add(birth);
    }
  };
  add_puffs(200, Vec3f(5, 0, 0), 0.01f);
  for (int step = 0; step < 5; ++step) dust.advance(kDt, obstacles.view());
  const std::size_t few = dust.air()->grid().lattice.cells();
  const double coarse_m = dust.air()->grid().cell_m;
  const float before = dust.air()->velocity(Vec3f(0.1f, 3, 0)).x();
  add_puffs(3000, Vec3f::Zero(), 0);
  dust.advance(kDt, obstacles.view());
  EXPECT_GT(dust.air()->grid().lattice.cells(), few);
  EXPECT_LT(dust.air()->grid().cell_m, coarse_m);
  EXPECT_GT(before, 0.1f);
  EXPECT_NEAR(dust.air()->velocity(Vec3f(0.1f, 3, 0)).x(), before, 0.25 * double{before});
}

TEST(Dust, OverItsLimitIsRejectedAndCounted) {
  Dust dust(64, kGravity, kCounts);
  const TestObstacles obstacles;
  for (int i = 0; i < 100; ++i) dust.add(puff_at(Vec3f(0, 1, 0)));
  EXPECT_EQ(dust.counts().alive, 64u);
  EXPECT_EQ(dust.counts().ignored, 36u);
  for (int step = 0; step < 60; ++step) dust.advance(kDt, obstacles.view());
  EXPECT_LE(dust.counts().alive, 60u) << "the oldest were removed";
}

Vec3f velocity_in(const Swirl& swirl, std::size_t cell, const Vec3f& at) {
  Swirl::Near near;
  swirl.find(cell, near);
  return near.velocity(at);
}

TEST(Swirl, IsGivenByTheOrientationOfItsVortices) {
  const Lattice lattice{kCounts};
  Swirl swirl(lattice);
  const std::size_t cell = lattice.index(5, 5, 5);
  const Vec3f center(4.5f, 4.5f, 4.5f);
  const auto velocity_about = [&](const Vec3f& axis, float speed) {
    swirl.clear();
    swirl.add(cell, center, axis, speed);
    swirl.finish();
    return velocity_in(swirl, cell, center + Vec3f(0.4f, 0, 0));
  };
  const Vec3f about_z = velocity_about(Vec3f::UnitZ(), 1);
  EXPECT_NEAR(about_z.y(), std::sqrt(2.0 / 3), 0.1);
  EXPECT_EQ(velocity_about(-Vec3f::UnitZ(), 1), -about_z);
  EXPECT_GT(velocity_about(-Vec3f::UnitY(), 1).z(), 0.5f);
  EXPECT_EQ(velocity_about(Vec3f::UnitX(), 1).norm(), 0) << "on its own axis";
  EXPECT_EQ(velocity_about(Vec3f::UnitZ(), 0).norm(), 0) << "without energy";
}

TEST(Swirl, EndsACellsWidthAway) {
  const Lattice lattice{kCounts};
  Swirl swirl(lattice);
  swirl.add(lattice.index(5, 5, 5), Vec3f(4.1f, 4.5f, 4.5f), Vec3f::UnitZ(), 1);
  swirl.finish();
  EXPECT_GT(velocity_in(swirl, lattice.index(5, 5, 5), Vec3f(4.9f, 4.5f, 4.5f)).norm(), 0);
  EXPECT_EQ(velocity_in(swirl, lattice.index(6, 5, 5), Vec3f(5.2f, 4.5f, 4.5f)).norm(), 0);
}

TEST(Dust, MovesDifferentlyWhenItsParticlesAreRotated) {
  const auto drift = [](const Quatf& rotation) {
    Dust dust(1000, Vec3::Zero(), kCounts);
    TestObstacles obstacles;
    // The strain around the moving ball is the source of the particles' turbulence.
    obstacles.set_velocity(obstacles.add_ball(Vec3(-0.5, 1, 0), 0.3), Vec3(4, 0, 0));
    Random random(7);
    for (int i = 0; i < 200; ++i) {
      DustBirth birth = puff_at(Vec3f(0, 1, 0) + 0.4f * random.direction().cast<float>());
      birth.rotation_WD = rotation;
      dust.add(birth);
    }
    for (int step = 0; step < 30; ++step) {
      obstacles.advance(kDt);
      dust.advance(kDt, obstacles.view());
    }
    return std::vector<Vec3f>(dust.view().position_W.begin(), dust.view().position_W.end());
  };
  const std::vector<Vec3f> up = drift(Quatf::Identity());
  const std::vector<Vec3f> down = drift(Quatf(0, 1, 0, 0));
  ASSERT_EQ(up.size(), down.size());
  float distance = 0;
  for (std::size_t i = 0; i < up.size(); ++i)
    distance = std::max(distance, (up[i] - down[i]).norm());
  EXPECT_GT(distance, 0.02f);
}

TEST(Turbulence, GrowsInShearToItsBalanceAndDecaysInStillAir) {
  Mat3f shear = Mat3f::Zero();
  shear(0, 1) = shear(1, 0) = 5;
  const float cell_m = 0.25f;
  float speed = 0;
  for (int step = 0; step < 2000; ++step) speed = grow_turbulence(speed, shear, cell_m, 1.0f / 60);
  // Production 2 C_k Δ s S:S equals dissipation C_ε s³ / Δ.
  EXPECT_NEAR(speed, cell_m * std::sqrt(2 * 0.1f * 50), 0.02);
  const float before = speed;
  for (int step = 0; step < 60; ++step) {
    speed = grow_turbulence(speed, Mat3f::Zero(), cell_m, 1.0f / 60);
  }
  // ds/dt = −C_ε s² / 2Δ.
  EXPECT_NEAR(speed, before / (1 + before / (2 * cell_m)), 0.05 * double{before});
}

TEST(RodSpin, TurnsARodIntoTheDirectionOfStretch) {
  const Mat3f stretch = Vec3f(1, -0.5f, -0.5f).asDiagonal();
  Vec3f axis = Vec3f(0.1f, 1, 0.3f).normalized();
  for (int step = 0; step < 600; ++step) {
    axis += rod_spin(axis, Vec3f::Zero(), stretch).cross(axis) / 60;
    axis.normalize();
  }
  EXPECT_GT(axis.x(), 0.999f);
}

TEST(RodSpin, TurnsHalfAsFastAsTheVorticityInRigidRotation) {
  EXPECT_EQ(rod_spin(Vec3f::UnitX(), Vec3f(0, 0, 4), Mat3f::Zero()), Vec3f(0, 0, 2));
}

}  // namespace
}  // namespace sunder::solver::dust_test
