// Tests of paths by keyframes.
#include "engine/model/path.h"

#include <gtest/gtest.h>

namespace sunder {
namespace {

constexpr double kDifference_s = 1e-5;

Vec3 speed(const Path& path, double time_s) {
  return (path.at(time_s + kDifference_s).shift_W - path.at(time_s - kDifference_s).shift_W) /
         (2 * kDifference_s);
}

Path zigzag() {
  Path path;
  path.keys = {{1, Vec3(1, 0, 0), Vec3(0, 1, 0)},
               {1.5, Vec3(3, 2, 0), Vec3(0, 9, 0)},
               {4, Vec3(2, 3, 1), Vec3(0, 8, 0)}};
  return path;
}

TEST(Path, GoesFromRestThroughItsKeysAndStaysAtTheLast) {
  for (const bool smooth : {true, false}) {
    Path path = zigzag();
    path.smooth = smooth;
    EXPECT_EQ(path.at(0).shift_W, Vec3::Zero());
    for (const PathKey& key : path.keys) {
      EXPECT_LT((path.at(key.time_s).shift_W - key.shift_W).norm(), 1e-12);
      EXPECT_LT((path.at(key.time_s).rotation_W - key.rotation_W).norm(), 1e-12);
    }
    EXPECT_EQ(path.at(100).shift_W, path.at(4).shift_W);
  }
  EXPECT_EQ(Path().at(3).shift_W, Vec3::Zero()) << "a path without keys stays at zero";
}

TEST(Path, ASmoothPathHasNoJumpOfVelocityAndNoOvershoot) {
  const Path path = zigzag();
  Vec3 before = speed(path, kDifference_s);
  EXPECT_LT(before.norm(), 1e-3) << "from rest";
  for (double t = 0.002; t < 4.1; t += 0.002) {
    const Vec3 now = speed(path, t), at = path.at(t).shift_W;
    EXPECT_LT((now - before).norm(), 0.2) << t;
    EXPECT_TRUE((at.array() > -1e-12).all() && at.x() < 3 + 1e-12 && at.y() < 3 + 1e-12) << t;
    before = now;
  }
  EXPECT_LT(before.norm(), 1e-3) << "to rest";
}

TEST(Path, EqualSpeedsBetweenKeysGiveAConstantSpeed) {
  Path path;
  path.keys = {{0.5, Vec3(1, 0, 0)}, {1, Vec3(3, 0, 0)}, {2, Vec3(7, 0, 0)}, {3, Vec3(8, 0, 0)}};
  for (const double t : {0.6, 0.9}) EXPECT_GT(speed(path, t).x(), 2) << t;
  Path even = path;
  even.keys = {{1, Vec3(2, 0, 0)}, {2, Vec3(4, 0, 0)}, {3.5, Vec3(7, 0, 0)}, {4, Vec3(8, 0, 0)}};
  for (const double t : {1.1, 1.5, 2.3, 3.4}) EXPECT_NEAR(speed(even, t).x(), 2, 1e-6) << t;
  path.smooth = false;
  for (const double t : {0.1, 0.4}) EXPECT_NEAR(speed(path, t).x(), 2, 1e-6) << t;
  EXPECT_NEAR(speed(path, 1.5).x(), 4, 1e-6);
}

TEST(Path, ALoopRepeatsWithoutAJump) {
  Path drum;
  drum.loops = true;
  drum.keys = {{1, Vec3::Zero(), Vec3(0, 3.14, 0)}, {2, Vec3::Zero(), Vec3(0, 6.28, 0)}};
  for (const double t : {0.0, 0.3, 1.7, 5.9}) {
    const double turned = (drum.at(t + 0.05).rotation_W - drum.at(t).rotation_W).y();
    EXPECT_NEAR(turned, 0.05 * 3.14, 1e-9) << t;
  }
  Path shuttle;
  shuttle.loops = true;
  shuttle.keys = {{1, Vec3(1, 0, 0)}, {3, Vec3::Zero()}};
  for (const double t : {0.2, 1.0, 2.5}) {
    EXPECT_LT((shuttle.at(t + 6).shift_W - shuttle.at(t).shift_W).norm(), 1e-12) << t;
  }
  EXPECT_LT((speed(shuttle, 3 - 0.001) - speed(shuttle, 3 + 0.001)).norm(), 0.02);
}

}  // namespace
}  // namespace sunder
