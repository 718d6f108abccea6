// Tests of whole runs against calculations by hand, at several time steps: an impact breaks a solid
// if its work suffices, and loses exactly the energy of the break.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/motion/decided.h"

namespace sunder::tests {
namespace {

class AtAnyStep : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, AtAnyStep,
                         testing::Values(1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 960));

/// Returns the speed of a mass after a loss of energy.
double speed_left_m_s(double mass_kg, double speed_m_s, double lost_J) {
  return std::sqrt(std::max(0.0, speed_m_s * speed_m_s - 2 * lost_J / mass_kg));
}

TEST_P(AtAnyStep, ABallGoesThroughWallsAndLosesTheEnergyOfTheirBreaks) {
  const Ball ball = steel_ball(0.15, Vec3(0, 0.05, 0.03), Vec3(25, 0, 0));
  // In some runs a piece is wedged between the ball and the remains of a wall, which costs more.
  double more = 0;
  int runs = 0;
  for (const double toughness : {3000.0, 9000.0}) {
    for (int n = 1; n <= 5; ++n) {
      Scene scene = bare_scene(GetParam(), toughness, 2);
      for (int i = 0; i < n; ++i) {
        scene.solids.push_back(wall(0, Vec3(1.0 + 0.5 * i, 0, 0), 2, 0.05));
      }
      scene.balls = {ball};
      Trial run(scene);
      const auto key = static_cast<std::uint64_t>(n);
      run.step_until(
          1, [&](const FrameBody& b) { return b.X_WB.position.x() > 1.5 + 0.5 * n; }, key);
      EXPECT_GE(run.breaks.size(), static_cast<std::size_t>(n));
      EXPECT_GT(run.broken_J, 0.02 * n * kinetic_J(ball_kg(ball), 25));
      const double left = speed_left_m_s(ball_kg(ball), 25, run.broken_J);
      const double off = run.body(key).velocity_W.norm() / left - 1;
      EXPECT_NEAR(off, 0, 0.15) << n << " walls, " << run.breaks.size() << " breaks, "
                                << run.broken_J << " J";
      more -= off;
      ++runs;
    }
  }
  EXPECT_NEAR(more / runs, 0, 0.03);
}

TEST_P(AtAnyStep, BallsThatHitOneWallAtOnceLoseTheEnergyOfTheBreaks) {
  Scene scene = bare_scene(GetParam(), 9000, 2);
  scene.solids = {wall(0, Vec3(1, 0, 0), 8, 0.05)};
  for (int i = 0; i < 10; ++i) {
    const Vec3 from(0, 3 * (i % 2) - 1.5, 1.4 * (i / 2) - 2.8);
    scene.balls.push_back(steel_ball(0.15, from, Vec3(25, 0, 0)));
  }
  Trial run(scene);
  while (run.frame->time_s < 0.3) run.step();
  EXPECT_GE(run.breaks.size(), 10u);
  EXPECT_EQ(run.frame->report.carried_over, 0u);
  const double kg = ball_kg(scene.balls[0]);
  double left_J = 0;
  for (std::uint64_t key = 1; key <= 10; ++key) {
    left_J += kinetic_J(kg, run.body(key).velocity_W.norm());
    EXPECT_GT(run.body(key).X_WB.position.x(), 1.5) << key;
  }
  EXPECT_NEAR(10 * kinetic_J(kg, 25) - left_J, run.broken_J, 0.03 * 10 * kinetic_J(kg, 25));
}

TEST_P(AtAnyStep, ADeferredImpactLosesNoEnergyByTheDelay) {
  Scene scene = bare_scene(GetParam(), 9000, 2);
  scene.limits.parts_a_frame = 12;  // one break a frame
  for (int i = 0; i < 4; ++i) {
    scene.solids.push_back(wall(0, Vec3(1, 0, 3 * i), 2, 0.05));
    scene.balls.push_back(steel_ball(0.15, Vec3(0, 0.05, 3 * i), Vec3(25, 0, 0)));
  }
  Trial run(scene);
  std::uint32_t max_deferred = 0;
  while (run.frame->time_s < 0.3) {
    run.step();
    max_deferred = std::max(max_deferred, run.frame->report.carried_over);
    EXPECT_LE(run.frame->breaks.size(), 1u);
  }
  EXPECT_EQ(max_deferred, 3u);
  const double kg = ball_kg(scene.balls[0]);
  double left_J = 0;
  for (std::uint64_t key = 4; key < 8; ++key) {
    left_J += kinetic_J(kg, run.body(key).velocity_W.norm());
    EXPECT_GT(run.body(key).X_WB.position.x(), 1.5);
  }
  EXPECT_NEAR(4 * kinetic_J(kg, 25) - left_J, run.broken_J, 0.03 * 4 * kinetic_J(kg, 25));
}

TEST_P(AtAnyStep, ABulletBreaksTwoPanesInOneStepAndLosesExactlyTheReportedEnergy) {
  const Ball bullet = steel_ball(0.01, Vec3::Zero(), Vec3(200, 0, 0));
  Scene scene = bare_scene(GetParam(), 3000, 0.001);
  scene.solids = {wall(0, Vec3(0.062, 0.1, 0), 1, 0.004), wall(0, Vec3(0.162, 0.1, 0), 1, 0.004)};
  scene.balls = {bullet};
  Trial run(scene);
  run.step();
  ASSERT_EQ(run.breaks.size(), 2u);
  EXPECT_EQ(run.breaks[0].time_s, run.breaks[1].time_s);
  const double all_J = kinetic_J(ball_kg(bullet), 200);
  EXPECT_GT(run.broken_J, 0.1 * all_J);
  const double speed = run.body(2).velocity_W.norm();
  EXPECT_NEAR(all_J - kinetic_J(ball_kg(bullet), speed), run.broken_J, 1e-3 * run.broken_J);
}

/// Returns a scene of a ball about to hit a block that `joint` connects to the world.
Scene joined_block(double dt_s, double speed_m_s, const Joint& joint) {
  Scene scene = bare_scene(dt_s, 300, 500);
  scene.solids = {box_solid(Vec3::Zero(), Vec3(0.4, 0.4, 0.4))};
  scene.materials[0].smallest_break_m3 = 0.99 * volume(scene.solids[0].compound);
  scene.balls = {steel_ball(0.1, Vec3(-0.31, 0, 0), Vec3(speed_m_s, 0, 0))};
  scene.joints = {joint};
  return scene;
}

TEST_P(AtAnyStep, ABlockFixedToTheWorldBearsTheWholeImpactEnergy) {
  Joint joint;
  joint.kind = JointDesc::Kind::kFixed;
  joint.a = 0;
  joint.at_W = Vec3(0.15, 0.15, 0.15);
  const double ball_mass = ball_kg(steel_ball(0.1, Vec3::Zero(), Vec3::Zero()));
  expect_decided_by_work([&](double speed) { return joined_block(GetParam(), speed, joint); },
                         [&](double speed) { return kinetic_J(ball_mass, speed); }, false);
}

TEST_P(AtAnyStep, ABlockOnARopeBearsTheImpactEnergyOfAFreeBlock) {
  Joint joint;
  joint.kind = JointDesc::Kind::kRope;
  joint.a = 0;
  joint.at_W = Vec3(0, 0.2, 0);
  joint.to_W = Vec3(0, 2.2, 0);
  const double ball_mass = ball_kg(steel_ball(0.1, Vec3::Zero(), Vec3::Zero()));
  const double block_mass = 500 * 0.4 * 0.4 * 0.4;
  expect_decided_by_work([&](double speed) { return joined_block(GetParam(), speed, joint); },
                         [&](double speed) {
                           return block_mass / (block_mass + ball_mass) *
                                  kinetic_J(ball_mass, speed);
                         },
                         false);
}

TEST_P(AtAnyStep, APlateOnAPaneTransmitsAnImpact) {
  const Ball ball = steel_ball(0.1, Vec3(0, 0.3, 0), Vec3::Zero());
  const double plate_kg = 8000 * 0.3 * 0.3 * 0.04;
  expect_decided_by_work(
      [&](double speed) {
        Scene scene = bare_scene(GetParam(), 1000, 10);
        scene.solids = {wall(1, Vec3::Zero(), 1, 0.05),
                        box_solid(Vec3(0, 0.045, 0), Vec3(0.3, 0.04, 0.3), 0, kSteel)};
        scene.balls = {ball};
        scene.balls[0].velocity_W.y() = -speed;
        return scene;
      },
      [&](double speed) {
        const double m = ball_kg(ball);
        return kinetic_J(m, speed) * m / (m + plate_kg);
      });
}

TEST_P(AtAnyStep, ARowOfBallsTransmitsAnImpactToItsEnd) {
  constexpr int kBalls = 5;
  const Ball ball = steel_ball(0.1, Vec3::Zero(), Vec3::Zero());
  expect_decided_by_work(
      [&](double speed) {
        Scene scene = bare_scene(GetParam(), 500, 10);
        scene.solids = {wall(0, Vec3(0.125, 0, 0), 1, 0.05)};
        for (int i = 0; i < kBalls; ++i) {
          scene.balls.push_back(ball);
          scene.balls.back().center_W.x() = -0.2 * i;
        }
        scene.balls.back().center_W.x() -= 0.1;
        scene.balls.back().velocity_W.x() = speed;
        return scene;
      },
      [&](double speed) { return kinetic_J(ball_kg(ball), speed) / kBalls; });
}

TEST_P(AtAnyStep, ASmallBallInFrontOfABallDoesNotKeepItFromTheWall) {
  const Ball ball = steel_ball(0.15, Vec3::Zero(), Vec3(25, 0, 0));
  const Ball small_ball = steel_ball(0.01, Vec3(0.16, 0, 0), Vec3(25, 0, 0));
  Scene scene = bare_scene(GetParam(), 9000, 10);
  scene.solids = {wall(0, Vec3(1, 0, 0), 2, 0.05)};
  scene.balls = {ball, small_ball};
  Trial run(scene);
  run.step_until(
      1, [&](const FrameBody& b) { return b.X_WB.position.x() > 1.5; }, 1);
  EXPECT_GE(run.breaks.size(), 1u);
  const double left = speed_left_m_s(ball_kg(ball), 25, run.broken_J);
  EXPECT_NEAR(run.body(1).velocity_W.norm(), left, 0.03 * left);
}

/// Runs a steel slab that lands flat on ten columns at a speed, until a break or for 1 s.
Trial land(double dt_s, double speed_m_s) {
  Scene scene = bare_scene(dt_s, 3000, 10);
  scene.materials[0].strength_Ns = 1;
  const auto foot = anchor_side(1, false);
  for (int i = 0; i < 10; ++i) {
    scene.solids.push_back(
        box_solid(Vec3(i % 5 - 2.0, 0.5, i < 5 ? -1 : 1), Vec3(0.2, 1, 0.2), foot));
  }
  scene.solids.push_back(box_solid(Vec3(0, 1.2, 0), Vec3(5, 0.2, 3), 0, kSteel));
  scene.solids.back().velocity_W.y() = -speed_m_s;
  Trial run(scene);
  while (run.frame->time_s < 1 && run.breaks.empty()) run.step();
  return run;
}

TEST_P(AtAnyStep, AFlatSlabBreaksTenColumnsOrNone) {
  const double slab_kg = 8000 * 5 * 0.2 * 3;
  const Trial strong = land(GetParam(), 3);
  ASSERT_EQ(strong.breaks.size(), 10u);
  EXPECT_NEAR(strong.kinetic_J(), kinetic_J(slab_kg, 3) - strong.broken_J,
              0.03 * kinetic_J(slab_kg, 3));
  double least_J = strong.broken_J, most_J = 0;
  for (const BreakEvent& event : strong.breaks) {
    least_J = std::min(least_J, event.energy_J);
    most_J = std::max(most_J, event.energy_J);
  }
  const auto speed = [&](double each_J) { return std::sqrt(2 * 10 * each_J / slab_kg); };
  EXPECT_TRUE(land(GetParam(), 0.93 * speed(least_J)).breaks.empty());
  const Trial barely = land(GetParam(), 1.07 * speed(most_J));
  EXPECT_EQ(barely.breaks.size(), 10u);
  const double before_J = kinetic_J(slab_kg, 1.07 * speed(most_J));
  EXPECT_NEAR(barely.kinetic_J(), before_J - barely.broken_J, 0.03 * before_J);
}

}  // namespace
}  // namespace sunder::tests
