// Tests of debris: fall, bounces, collisions with obstacles, rest, sleep, and its budget.
#include "solver/particles/debris.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver::debris_test {
namespace {

constexpr double kDt = 1.0 / 120;
const Vec3 kGravity(0, -9.81, 0);

DebrisBirth chip_at(const Vec3f& position, const Vec3f& velocity = Vec3f::Zero()) {
  DebrisBirth birth;
  birth.position_W = position;
  birth.velocity_W = velocity;
  birth.radius_m = 0.02f;
  return birth;
}

void run(Debris& debris, TestObstacles& obstacles, double seconds) {
  for (int step = 0; step < seconds / kDt; ++step) {
    obstacles.advance(kDt);
    debris.advance(kDt, obstacles.view());
  }
}

TEST(Debris, FallsUnderGravity) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  debris.add(chip_at(Vec3f(0, 20, 0), Vec3f(3, 0, 0)));
  run(debris, obstacles, 1);
  const Vec3f at = debris.view().position_W[0];
  EXPECT_NEAR(at.x(), 3, 1e-3);
  EXPECT_NEAR(at.y(), 20 - 0.5 * 9.81, 0.5 * 9.81 * kDt + 1e-3);
}

TEST(Debris, NeverPassesTheGroundAndConservesItsCount) {
  Debris debris(2000, kGravity);
  TestObstacles obstacles;
  obstacles.ground_m = -1.5;
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    debris.add(chip_at(random.direction().cast<float>(),
                       30 * random.direction().cast<float>() * float(random.uniform())));
  }
  for (int step = 0; step < 1200; ++step) {
    debris.advance(kDt, obstacles.view());
    const DebrisView view = debris.view();
    for (const Vec3f& at : view.position_W) ASSERT_GE(at.y(), -1.5f + 0.02f - 1e-6f);
    const ParticleCounts counts = debris.counts();
    ASSERT_EQ(counts.emitted, 2000u);
    ASSERT_EQ(counts.alive, counts.emitted - counts.gone);
  }
  EXPECT_EQ(debris.counts().awake, 0u) << "all asleep after 10 s";
}

TEST(Debris, AtRestStaysWhereItIsBitForBit) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  debris.add(chip_at(Vec3f(0, 0.3f, 0), Vec3f(0.5f, 0, 0)));
  run(debris, obstacles, 3);
  ASSERT_EQ(debris.counts().awake, 0u);
  const Vec3f before = debris.view().position_W[0];
  run(debris, obstacles, 3);
  EXPECT_EQ(debris.view().position_W[0], before);
}

TEST(Debris, LiesOnATiltedBoxByFrictionAndWakesWhenTheBoxIsRemoved) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  const double half = 0.15;  // Tilt of the box in rad.
  obstacles.add_box(Vec3(0, 2, 0), Vec3(1, 0.1, 1), Quat(1, 0, 0, half / 2).normalized());
  debris.add(chip_at(Vec3f(0, 2.2f, 0)));
  run(debris, obstacles, 2);
  ASSERT_EQ(debris.counts().awake, 0u);
  EXPECT_NEAR(debris.view().position_W[0].y(), 2.12, 0.03);
  obstacles.bodies.clear();
  obstacles.shapes.clear();
  run(debris, obstacles, 0.3);
  EXPECT_EQ(debris.counts().awake, 1u);
  EXPECT_LT(debris.view().position_W[0].y(), 2);
  run(debris, obstacles, 3);
  EXPECT_NEAR(debris.view().position_W[0].y(), 0.02, 1e-3);
}

TEST(Debris, DoesNotPassAThinPaneAtHighSpeed) {
  Debris debris(500, kGravity);
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0, 0, 0), Vec3(0.005, 50, 50), Quat(1, 0, 0.1, 0).normalized());
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    debris.add(chip_at(Vec3f(-2, 10 + float(random.uniform()), 0),
                       Vec3f(20 + 100 * float(random.uniform()), 0, 0)));
  }
  run(debris, obstacles, 0.5);
  const Vec3f normal = (Quat(1, 0, 0.1, 0).normalized() * Vec3::UnitX()).cast<float>();
  for (const Vec3f& at : debris.view().position_W) ASSERT_LT(normal.dot(at), 0);
}

TEST(Debris, IsPushedByAMovingBodyEvenAsleep) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  debris.add(chip_at(Vec3f(0, 0.1f, 0)));
  run(debris, obstacles, 2);
  ASSERT_EQ(debris.counts().awake, 0u);
  obstacles.set_velocity(obstacles.add_box(Vec3(-1, 0.5, 0), Vec3(0.2, 0.5, 0.5)), Vec3(2, 0, 0));
  run(debris, obstacles, 1);
  EXPECT_GT(debris.view().position_W[0].x(), 1.2f - 0.01f);
}

TEST(Debris, IsHitByAPaneThatPassesItsPlaceWithinAStep) {
  Debris debris(10, Vec3::Zero());
  TestObstacles obstacles;
  debris.add(chip_at(Vec3f(0, 1, 0)));
  const double speed_m_s = 60;  // Half a metre per step.
  const Vec3 behind(-0.5 * speed_m_s * kDt, 1, 0);
  obstacles.set_velocity(obstacles.add_box(behind, Vec3(0.01, 0.5, 0.5)), Vec3(speed_m_s, 0, 0));
  run(debris, obstacles, kDt);
  EXPECT_GT(debris.view().position_W[0].x(), 0.1f);
}

TEST(Debris, StopsAtItsRadiusFromEverySideOfABox) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.f, 1.f}) {
      Debris debris(10, Vec3::Zero());
      TestObstacles obstacles;
      obstacles.ground_m = -9;
      obstacles.add_box(Vec3::Zero(), Vec3::Constant(0.5));
      debris.add(chip_at(sign * Vec3f::Unit(axis), -2 * sign * Vec3f::Unit(axis)));
      for (int step = 0; step < 60; ++step) {
        debris.advance(kDt, obstacles.view());
        ASSERT_GT(sign * debris.view().position_W[0][axis], 0.52f - 1e-3f) << axis << sign;
      }
    }
  }
}

TEST(Debris, IsHitByABarThatRotatesPastItsPlaceWithinAStep) {
  Debris debris(10, Vec3::Zero());
  TestObstacles obstacles;
  debris.add(chip_at(Vec3f(0.8f, 1, 0)));
  const double spin_rad_s = 60;  // Half a radian per step.
  const Quat after(Eigen::AngleAxisd(0.5 * spin_rad_s * kDt, Vec3::UnitY()));
  const std::size_t bar = obstacles.add_box(Vec3(0, 1, 0), Vec3(1, 0.5, 0.01), after);
  obstacles.bodies[bar].angular_velocity_W = Vec3(0, spin_rad_s, 0);
  obstacles.bodies[bar].moves = true;
  debris.advance(kDt, obstacles.view());
  EXPECT_LT(debris.view().position_W[0].z(), -0.1f);
}

TEST(Debris, RidesOnALiftWithoutFallingThrough) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  obstacles.set_velocity(obstacles.add_box(Vec3(0, 0.5, 0), Vec3(1, 0.05, 1)), Vec3(0, 3, 0));
  debris.add(chip_at(Vec3f(0, 0.65f, 0)));
  run(debris, obstacles, 1);
  const double top = obstacles.bodies[0].X_WB.position.y() + 0.05;
  EXPECT_NEAR(debris.view().position_W[0].y(), top + 0.02, 0.02);
}

TEST(Debris, SleepsOnABodyThatHardlyMovesAndWakesWhenItHasMoved) {
  Debris debris(10, kGravity);
  TestObstacles obstacles;
  const std::size_t floor = obstacles.add_box(Vec3(0, 0.5, 0), Vec3(1, 0.05, 1));
  obstacles.set_velocity(floor, Vec3(0, 0, 1e-5));
  debris.add(chip_at(Vec3f(0, 0.65f, 0)));
  run(debris, obstacles, 2);
  EXPECT_EQ(debris.counts().awake, 0u);
  obstacles.set_velocity(floor, Vec3(0.02, 0, 0));  // The motion is detected after some steps.
  run(debris, obstacles, 0.2);
  EXPECT_EQ(debris.counts().awake, 1u);
}

TEST(Debris, SlidesDownWallsAndFallsAsleepBelowAtAnyLengthOfStep) {
  for (const double dt_s : {1. / 30, 1. / 60, 1. / 120, 1. / 480, 1. / 1920}) {
    for (const double lean_rad : {-0.1, 0., 0.1, 0.4}) {
      for (const double radius_m : {0.005, 0.02, 0.1}) {
        Debris debris(200, kGravity);
        TestObstacles obstacles;
        const Quat lean(Eigen::AngleAxisd(lean_rad, Vec3::UnitZ()));
        obstacles.add_box(Vec3(0, 2, 0), Vec3(0.15, 2, 3), lean);
        Random random(5);
        for (int i = 0; i < 50; ++i) {
          // Some of them begin within the wall.
          const Vec3 at_B(-0.15 - random.uniform(-0.5, 2) * radius_m, random.uniform(-0.5, 1),
                          random.uniform(-1, 1));
          DebrisBirth chip = chip_at((Vec3(0, 2, 0) + lean * at_B).cast<float>(),
                                     0.3f * random.direction().cast<float>());
          chip.radius_m = static_cast<float>(radius_m);
          debris.add(chip);
        }
        const auto steps = static_cast<int>(4 / dt_s);
        for (int step = 0; step < steps; ++step) debris.advance(dt_s, obstacles.view());
        EXPECT_EQ(debris.counts().awake, 0u) << dt_s << " s, " << lean_rad << ", " << radius_m;
        for (const Vec3f& at : debris.view().position_W)
          EXPECT_NEAR(at.y(), radius_m, 1e-3) << dt_s << " s, " << lean_rad << ", " << radius_m;
      }
    }
  }
}

TEST(Debris, RestsOnObstaclesOfAnySizeNumberAndPlace) {
  Debris debris(200, kGravity);
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0, 0.25, 0), Vec3(400, 0.25, 400));
  for (int i = 0; i < 2000; ++i) obstacles.add_box(Vec3(0.05 * i, 0.52, 1), Vec3(0.02, 0.02, 0.02));
  obstacles.add_box(Vec3(5000, 1, 5000), Vec3(1, 1, 1));
  for (int i = 0; i < 50; ++i) debris.add(chip_at(Vec3f(float(i) + 0.025f, 1, 1)));
  for (int i = 0; i < 50; ++i) debris.add(chip_at(Vec3f(float(i), 1, -300 + float(i))));
  run(debris, obstacles, 2);
  const DebrisView view = debris.view();
  ASSERT_EQ(view.position_W.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_GE(view.position_W[i].y(), 0.519f) << i;
    EXPECT_LE(view.position_W[i].y(), 0.57f) << i;
  }
}

TEST(Debris, BouncesOffABall) {
  Debris debris(10, Vec3::Zero());
  TestObstacles obstacles;
  obstacles.add_ball(Vec3(0, 5, 0), 0.5);
  debris.add(chip_at(Vec3f(-2, 5, 0), Vec3f(4, 0, 0)));
  run(debris, obstacles, 1);
  const Vec3f at = debris.view().position_W[0];
  EXPECT_LT(at.x(), -0.52f);
  EXPECT_GT(at.x(), -2);
}

TEST(Debris, OverItsBudgetFadesTheOldestAtRestAndOverItsLimitRejectsChips) {
  Debris debris(160, kGravity);
  TestObstacles obstacles;
  for (int i = 0; i < 100; ++i) debris.add(chip_at(Vec3f(float(i), 0.05f, 0)));
  run(debris, obstacles, 1);
  ASSERT_EQ(debris.counts().awake, 0u);
  for (int i = 0; i < 70; ++i) debris.add(chip_at(Vec3f(float(i), 0.05f, 5)));
  EXPECT_EQ(debris.counts().alive, 160u);
  EXPECT_EQ(debris.counts().ignored, 10u);
  run(debris, obstacles, 2);
  const ParticleCounts counts = debris.counts();
  EXPECT_EQ(counts.alive, counts.emitted - counts.gone);
  EXPECT_LE(counts.alive, 150u) << "space for new chips";
  EXPECT_GE(counts.alive, 130u) << "not more removed than needed";
  for (const Vec3f& at : debris.view().position_W) {
    if (at.z() > 4) continue;
    EXPECT_GE(at.x(), 10) << "the oldest must be removed first";
  }
}

TEST(Debris, OverItsBudgetShrinksSmallChipsBeforeLargeOnes) {
  Debris debris(160, kGravity);
  TestObstacles obstacles;
  std::vector<float> full_m;
  const auto add = [&](float x, float z, float radius_m) {
    DebrisBirth chip = chip_at(Vec3f(x, radius_m, z));
    chip.radius_m = radius_m;
    debris.add(chip);
    full_m.push_back(radius_m);
  };
  for (int i = 0; i < 100; ++i) add(float(i), 0, i % 2 == 0 ? 0.15f : 0.05f);
  run(debris, obstacles, 1);
  for (int i = 0; i < 55; ++i) add(float(i), 5, 0.05f);
  ASSERT_EQ(debris.counts().ignored, 0u);
  for (int step = 0; step < 20; ++step) {
    run(debris, obstacles, 0.9 * kDt);
    ASSERT_EQ(debris.counts().alive, 155u) << "no chip may vanish at once";
  }
  int shrinking = 0;
  for (std::size_t chip = 0; chip < full_m.size(); ++chip) {
    const float drawn_m = debris.view().radius_m[chip];
    ASSERT_GT(drawn_m, 0.4f * full_m[chip]);
    if (drawn_m == full_m[chip]) continue;
    ++shrinking;
    EXPECT_LT(full_m[chip], 0.1f) << "a large chip goes before a small one";
  }
  EXPECT_GE(shrinking, 5);
  EXPECT_LE(shrinking, 30) << "the surplus and a reserve";
}

}  // namespace
}  // namespace sunder::solver::debris_test
