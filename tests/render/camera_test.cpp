// Tests of the cameras: their view at each time, and the smoothness of their motion.
#include "render/camera.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

constexpr double kFrame_s = 1.0 / 60;

/// Returns a frame without bodies, with the names house.0, house.1 and ball.
SyntheticFrame frame_at(int index) {
  SyntheticFrame s;
  s.frame.index = static_cast<std::uint64_t>(index);
  s.frame.time_s = index * kFrame_s;
  s.frame.view.eye_W = {0, 3, 12};
  s.frame.view.target_W = {0, 1, 0};
  s.frame.names = std::make_shared<const std::vector<std::string>>(
      std::vector<std::string>{"house.0", "house.1", "ball"});
  return s;
}

/// Adds a ball with this key and index of a name.
FrameBody& add_ball(SyntheticFrame& s, std::uint64_t key, std::uint32_t name, const Vec3& place,
                    double radius_m = 0.5) {
  s.add_ball(place, radius_m, Stuff::kSteel);
  FrameBody& body = s.frame.bodies.back();
  body.key = body.previous_key = key;
  body.name = name;
  return body;
}

TEST(Camera, AnUnknownViewIsRefusedWithTheAllowedOnes) {
  for (const char* wrong : {"", "orbti", "orbit:", "orbit:0", "orbit:x", "orbit:nan", "follow",
                            "follow:", "fixed:1", "auto:2"}) {
    try {
      make_camera(wrong);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("orbit"), std::string::npos) << error.what();
    }
  }
}

TEST(Camera, AFixedCameraHasTheViewOfTheFrames) {
  const auto camera = make_camera("fixed");
  EXPECT_EQ(camera->at(frame_at(7).frame).eye_W, Vec3(0, 3, 12));
}

TEST(Camera, AnOrbitGoesRoundAtConstantHeightAndDistance) {
  const auto camera = make_camera("orbit:2");
  const auto back = make_camera("orbit:-2");
  const auto eye = [&](Camera& c, int index) { return c.at(frame_at(index).frame).eye_W; };
  EXPECT_EQ(eye(*camera, 0), Vec3(0, 3, 12));
  EXPECT_LT((eye(*camera, 30) - Vec3(12, 3, 0)).norm(), 1e-9) << "to the right, a quarter round";
  EXPECT_LT((eye(*back, 30) - Vec3(-12, 3, 0)).norm(), 1e-9);
  EXPECT_LT((eye(*camera, 60) - Vec3(0, 3, -12)).norm(), 1e-9);
  EXPECT_LT((eye(*camera, 120) - Vec3(0, 3, 12)).norm(), 1e-9);
}

TEST(Camera, APathGoesThroughItsKeysSmoothly) {
  const std::vector<ViewKey> keys{{0.5, Vec3(0, 2, 10), std::nullopt, std::nullopt},
                                  {1, Vec3(10, 2, 0), Vec3(0, 2, 0), 0.5},
                                  {2, Vec3(0, 8, -10), std::nullopt, std::nullopt}};
  const auto camera = make_camera(keys);
  const auto at = [&](int index) { return camera->at(frame_at(index).frame); };
  EXPECT_EQ(at(0).eye_W, Vec3(0, 2, 10)) << "at the first key until then";
  EXPECT_EQ(at(0).target_W, Vec3(0, 1, 0)) << "without a key the target is that of the frames";
  EXPECT_LT((at(60).eye_W - Vec3(10, 2, 0)).norm(), 1e-9);
  EXPECT_LT((at(60).target_W - Vec3(0, 2, 0)).norm(), 1e-9);
  EXPECT_NEAR(at(90).fov_rad, 0.5, 1e-9) << "kept from the key before";
  EXPECT_EQ(at(500).eye_W, Vec3(0, 8, -10)) << "at the last from then on";
  Vec3 before_W = Vec3::Zero();
  for (int i = 1; i < 140; ++i) {
    const Vec3 step_W = at(i).eye_W - at(i - 1).eye_W;
    EXPECT_LT((step_W - before_W).norm(), 0.1) << i;
    before_W = step_W;
  }
}

TEST(Camera, AFollowingCameraKeepsItsBodyInTheMiddleAtConstantDistance) {
  const auto camera = make_camera("follow:ball");
  View view;
  for (int i = 0; i < 120; ++i) {
    SyntheticFrame s = frame_at(i);
    add_ball(s, 4, 0, {0, 1, 0}, 3);
    add_ball(s, 9, 2, {-20 + 0.5 * i, 1, 0}).velocity_W = {30, 0, 0};
    view = camera->at(s.frame);
    EXPECT_LT((view.target_W - s.frame.bodies[1].X_WB.position).norm(), 1e-6) << i;
  }
  EXPECT_LT((view.eye_W - view.target_W - Vec3(0, 2, 12)).norm(), 1e-9);
}

TEST(Camera, AFollowingCameraContinuesSmoothlyWithTheLargestPiece) {
  const auto camera = make_camera("follow:house");
  constexpr int kBreak = 30;
  Vec3 before_W = Vec3::Zero(), step_before_W = Vec3::Zero();
  double most_m = 0;
  View view;
  for (int i = 0; i < 240; ++i) {
    SyntheticFrame s = frame_at(i);
    const double since = i - kBreak;
    add_ball(s, 1, 1, {0, 2, 0}, 2);
    add_ball(s, 5, 1, {-1, 2, 0}, 0.4).previous_key = i == kBreak ? 1 : 5;
    FrameBody& large = add_ball(s, 6, 1, {1 + 0.1 * since, 2, 0}, 1);
    large.previous_key = i == kBreak ? 1 : 6;
    large.velocity_W = {6, 0, 0};
    add_ball(s, 7, 2, {0, 9, 0}, 8);  // larger, but no piece of the house
    // The house breaks into two pieces. The larger one has the higher key and flies off.
    if (i < kBreak) {
      s.frame.bodies.resize(1);
      s.frame.instances.resize(1);
    } else {
      s.frame.bodies.erase(s.frame.bodies.begin());
      s.frame.instances.erase(s.frame.instances.begin());
      for (Instance& instance : s.frame.instances) --instance.body;
    }
    view = camera->at(s.frame);
    if (i > 1) {
      most_m = std::max(most_m, (view.target_W - before_W - step_before_W).norm());
    }
    if (i > 0) step_before_W = view.target_W - before_W;
    before_W = view.target_W;
  }
  EXPECT_LT((view.target_W - Vec3(1 + 0.1 * 209, 2, 0)).norm(), 0.01) << "the camera has caught up";
  EXPECT_LT(most_m, 0.025) << "its speed changes little from frame to frame";
}

TEST(Camera, AFollowingCameraKeepsItsViewUntilTheBodyAppears) {
  const auto camera = make_camera("follow:ball");
  EXPECT_EQ(camera->at(frame_at(0).frame).target_W, Vec3(0, 1, 0));
  SyntheticFrame s = frame_at(1);
  add_ball(s, 9, 2, {8, 1, 0});
  const Vec3 target_W = camera->at(s.frame).target_W;
  EXPECT_LT((target_W - Vec3(0, 1, 0)).norm(), 0.5) << "the camera moves there smoothly";
}

TEST(Camera, AnUnknownNameIsRefusedWithTheNamesOfTheScene) {
  try {
    make_camera("follow:tower")->at(frame_at(0).frame);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("house.0, house.1, ball"), std::string::npos)
        << error.what();
  }
}

TEST(Camera, AnAutomaticCameraStaysWhileNothingMovesAndTurnsTowardsMotion) {
  const auto camera = make_camera("auto");
  SyntheticFrame still = frame_at(0);
  add_ball(still, 1, 0, {0, 1, 0}, 2);
  for (int i = 0; i < 60; ++i) {
    still.frame.time_s = i * kFrame_s;
    EXPECT_LT((camera->at(still.frame).eye_W - Vec3(0, 3, 12)).norm(), 1e-9);
  }
  View view;
  Vec3 eye_W(0, 3, 12), step_before_W = Vec3::Zero();
  for (int i = 60; i < 600; ++i) {
    SyntheticFrame s = frame_at(i);
    add_ball(s, 1, 0, {0, 1, 0}, 2);
    for (int b = 0; b < 2; ++b) {  // two balls roll about a point to the right
      add_ball(s, 2 + b, 2, {10, 1, b == 0 ? -1.0 : 1.0}, 1).velocity_W = {0, 0, 5};
    }
    view = camera->at(s.frame);
    EXPECT_LT((view.eye_W - eye_W - step_before_W).norm(), 0.02) << i;
    step_before_W = view.eye_W - eye_W;
    eye_W = view.eye_W;
  }
  EXPECT_LT((view.target_W - Vec3(10, 1, 0)).norm(), 1.2);
  EXPECT_LT((view.eye_W - view.target_W).norm(), 11) << "nearer, as it is small";
  EXPECT_LT((view.eye_W - view.target_W).normalized().cross(Vec3(0, 2, 12).normalized()).norm(),
            1e-9)
      << "from the same side";
}

TEST(Camera, NoCameraGoesBelowTheGround) {
  const auto camera = make_camera("follow:ball");
  SyntheticFrame s = frame_at(0);
  s.frame.view.eye_W = {0, -3, 12};
  add_ball(s, 9, 2, {8, 1, 0});
  EXPECT_GT(camera->at(s.frame).eye_W.y(), 0);
}

}  // namespace
}  // namespace sunder::render
