// Tests of bodies that the script moves along keyframes: impacts, release, joints, blasts.
#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/io/state_hash.h"
#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

constexpr double kDt_s = 1.0 / 120;

/// Returns `scene` with its first solid moved along `path`.
Scene moved(Scene scene, const Path& path) {
  scene.moves = {{{0}, path, std::nullopt}};
  return scene;
}

/// Returns a straight path from rest to `shift_W` at `time_s`.
Path straight(double time_s, const Vec3& shift_W) {
  Path path;
  path.keys = {{time_s, shift_W}};
  path.smooth = false;
  return path;
}

TEST(Moves, ABodyFollowsItsPathExactly) {
  Scene scene = bare_scene(kDt_s, 1, 2000);
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.solids = {box_solid(Vec3(1, 2, 3), Vec3(1, 2, 1))};
  Path path;
  path.keys = {{0.5, Vec3(1, 0, 0), Vec3(0, 2, 0)}, {2, Vec3(1, 3, 0), Vec3(1, 9, 0)}};
  scene.moves = {{{0}, path, Vec3(0, 2, 0)}};
  Trial trial(scene);
  while (trial.frame->time_s < 2.5) {
    trial.step();
    const PathKey key = path.at(trial.frame->time_s);
    const Quat turn(Eigen::AngleAxisd(key.rotation_W.norm(), key.rotation_W.normalized()));
    const Vec3 at_W = Vec3(0, 2, 0) + key.shift_W + turn * Vec3(1, 0, 3);
    EXPECT_LT((trial.body(0).X_WB.position - at_W).norm(), 1e-9) << trial.frame->time_s;
    EXPECT_LT(trial.body(0).X_WB.rotation.angularDistance(turn), 1e-6);
  }
  EXPECT_TRUE(trial.body(0).velocity_W.isZero(0)) << "the body rests at its last key";
}

TEST(Moves, ARamBreaksTheSolidThatItHitsAndNotItself) {
  Scene scene = bare_scene(kDt_s, 20, 1000);
  scene.solids = {box_solid(Vec3(-2, 0, 0), Vec3(1, 1, 1)),
                  box_solid(Vec3(1, 0, 0), Vec3(1, 1, 1))};
  Trial trial(moved(scene, straight(0.5, Vec3(5, 0, 0))));
  while (trial.frame->time_s < 0.4) {
    trial.step();
    for (const FrameBody& body : trial.frame->bodies) {
      const Vec3 distance_W = body.X_WB.position - trial.body(0).X_WB.position;
      EXPECT_TRUE(body.key == 0 || distance_W.cwiseAbs().maxCoeff() > 0.48)
          << "a piece is inside the ram";
    }
  }
  EXPECT_FALSE(trial.breaks.empty());
  for (const BreakEvent& event : trial.breaks) EXPECT_NE(event.parent_key, 0u);
  EXPECT_NEAR(trial.body(0).velocity_W.x(), 10, 1e-9)
      << "the velocity of the ram does not depend on what it broke";
  const double plastic_impact_J = 0.5 * 1000 * 10 * 10;  // 1000 kg at the speed of the ram
  EXPECT_GT(trial.kinetic_J(), 0.9 * plastic_impact_J) << "all pieces reach the speed of the ram";
  EXPECT_LT(trial.kinetic_J(), 2 * plastic_impact_J) << "and hardly faster";
}

TEST(Moves, ASlowBodyPushesWithoutBreaking) {
  Scene scene = bare_scene(kDt_s, 1e7, 1000);
  scene.solids = {box_solid(Vec3(-1.2, 0, 0), Vec3(1, 1, 1)),
                  box_solid(Vec3(0, 0, 0), Vec3(1, 1, 1))};
  Trial trial(moved(scene, straight(1, Vec3(1, 0, 0))));
  while (trial.frame->time_s < 0.9) trial.step();
  EXPECT_TRUE(trial.breaks.empty());
  EXPECT_NEAR(trial.body(1).velocity_W.x(), 1, 0.05);
}

TEST(Moves, AReleasedBodyKeepsItsVelocityAndCanBreak) {
  Scene scene = bare_scene(kDt_s, 20, 1000);
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.solids = {box_solid(Vec3::Zero(), Vec3(0.5, 0.5, 0.5)),
                  box_solid(Vec3(12, -3, 0), Vec3(1, 12, 6), 1, kSteel)};
  scene.moves = {{{0}, straight(2, Vec3(20, 0, 0)), std::nullopt, 0.5}};
  Trial trial(scene);
  while (trial.frame->time_s < 1) trial.step();
  const double flown_s = trial.frame->time_s - 0.5;
  EXPECT_NEAR(trial.body(0).X_WB.position.x(), 10, 1e-6);
  EXPECT_NEAR(trial.body(0).X_WB.position.y(), -0.5 * 9.81 * flown_s * flown_s, 1e-3);
  while (trial.frame->time_s < 1.4) trial.step();
  ASSERT_FALSE(trial.breaks.empty());
  EXPECT_EQ(trial.breaks[0].parent_key, 0u);
}

TEST(Moves, AChainStaysJoinedToACraneBeforeAndAfterItsRelease) {
  Scene scene = bare_scene(kDt_s, 1e7, 1000);
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.solids = {box_solid(Vec3(0, 0.2, 0), Vec3(1, 0.4, 1), 0, kSteel)};
  constexpr int kLinks = 8;
  for (int i = 0; i < kLinks; ++i) {
    scene.solids.push_back(box_solid(Vec3(0, -0.15 - 0.3 * i, 0), Vec3(0.1, 0.3, 0.1), 0, kSteel));
    Joint joint;
    joint.kind = JointKind::kBall;
    joint.a = static_cast<std::uint32_t>(i);
    joint.b = static_cast<std::uint32_t>(i + 1);
    joint.at_W = Vec3(0, -0.3 * i, 0);
    scene.joints.push_back(joint);
  }
  Path path;
  path.keys = {{2, Vec3(4, 1, 0)}, {4, Vec3(0, 0, 2), Vec3(0, 1, 0)}};
  scene.moves = {{{0}, path, std::nullopt, 3}};
  Trial trial(scene);
  /// Returns the largest gap between the foot of a body and the head of the next, in m.
  const auto max_gap_m = [&] {
    double most_m = 0;
    for (int i = 0; i < kLinks; ++i) {
      const Pose above = trial.body(static_cast<std::uint64_t>(i)).X_WB,
                 below = trial.body(static_cast<std::uint64_t>(i + 1)).X_WB;
      const Vec3 foot(0, i == 0 ? -0.2 : -0.15, 0);
      most_m = std::max(most_m, (above * foot - below * Vec3(0, 0.15, 0)).norm());
    }
    return most_m;
  };
  std::uint32_t lost = 0;
  while (trial.frame->time_s < 2.9) {
    trial.step();
    lost += trial.frame->report.joints_lost;
    EXPECT_LT(max_gap_m(), 0.01) << trial.frame->time_s;
    const PathKey key = path.at(trial.frame->time_s);
    const Vec3 at_W = Vec3(0, 0.2, 0) + key.shift_W;
    EXPECT_LT((trial.body(0).X_WB.position - at_W).norm(), 1e-6)
        << "the path does not depend on the chain";
  }
  EXPECT_GT(trial.body(kLinks).X_WB.position.x(), 0.5) << "it is taken along";
  while (trial.frame->time_s < 4) trial.step();
  EXPECT_LT(trial.body(0).X_WB.position.y(), -2) << "all falls";
  EXPECT_LT(max_gap_m(), 0.01);
  EXPECT_EQ(lost + trial.frame->report.joints_lost, 0u);
}

TEST(Moves, ABlastNeitherBreaksNorMovesABodyOnItsPath) {
  Scene scene = bare_scene(kDt_s, 20, 1000);
  scene.solids = {box_solid(Vec3::Zero(), Vec3(1, 1, 1)), box_solid(Vec3(3, 0, 0), Vec3(1, 1, 1))};
  scene.materials[0].smallest_break_m3 = 0.1;
  scene.blasts = {{0.05, Vec3(1.5, 0, 0), 4, 5000}};
  Trial trial(moved(scene, straight(1, Vec3(0, 1, 0))));
  while (trial.frame->time_s < 0.2) trial.step();
  ASSERT_FALSE(trial.breaks.empty());
  for (const BreakEvent& event : trial.breaks) EXPECT_NE(event.parent_key, 0u);
  EXPECT_NEAR(trial.body(0).X_WB.position.y(), trial.frame->time_s, 1e-9);
}

TEST(Moves, TheBitsAreEqualForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    set_threads(threads);
    Scene scene = bare_scene(kDt_s, 30, 1000);
    scene.gravity_W = Vec3(0, -9.81, 0);
    scene.ground.height_m = -0.5;
    scene.solids = {box_solid(Vec3(-3, 0.8, 0), Vec3(1, 2, 4), 0, kSteel)};
    scene.materials[0].smallest_break_m3 = 0.1;
    for (int i = 0; i < 4; ++i)
      scene.solids.push_back(box_solid(Vec3(i % 3, 0.5 * (i / 3), 0.1 * i), Vec3(0.9, 0.5, 0.9)));
    Path path;
    path.loops = true;
    path.keys = {{0.4, Vec3(4, 0, 0), Vec3(0, 0.5, 0)}, {1.2, Vec3::Zero()}};
    Trial trial(moved(scene, path));
    std::uint64_t hash = 0;
    while (trial.frame->time_s < 0.45) {
      trial.step();
      hash = combine(hash, hash_state(*trial.frame));
    }
    EXPECT_FALSE(trial.breaks.empty());
    set_threads(0);
    return hash;
  };
  const std::uint64_t one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(4), one);
}

}  // namespace
}  // namespace sunder::tests
