// Tests of light, exposure, samples per picture and motion blur.
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "render/frame_interpolation.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render::film_test {
namespace {

constexpr int kWidth = 320, kHeight = 180;

Image drawn(const Frame& frame, int samples = 1, const Frame* before = nullptr) {
  static std::map<int, std::unique_ptr<Renderer>> renderers;  // a renderer is slow to make
  std::unique_ptr<Renderer>& renderer = renderers[samples];
  if (!renderer) {
    RenderOptions options{.width = kWidth, .height = kHeight};
    options.samples = samples;
    renderer = std::make_unique<Renderer>(options);
  }
  return renderer->draw(frame, before);
}

/// Returns the mean red, green and blue over a part of the picture.
Vec3 mean(const Image& image, int left = 0, int top = 0, int right = kWidth, int bottom = kHeight) {
  Vec3 sum = Vec3::Zero();
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const auto i = 3 * static_cast<std::size_t>(y * image.width + x);
      sum += Vec3(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
    }
  }
  return sum / ((right - left) * (bottom - top));
}

/// Returns a frame of a ball at `center` in front of the sky.
Frame ball_at(const Vec3& center) {
  SyntheticFrame s;
  s.add_ball({0, 3, 0}, 0.5, Stuff::kConcrete);
  s.frame.bodies[0].key = 7;
  s.frame.bodies[0].X_WB.position += center - Vec3(0, 3, 0);
  s.frame.view.eye_W = Vec3(0, 3, 8);
  s.frame.view.target_W = Vec3(0, 4, 0);
  s.frame.time_s = 1;
  return s.frame;
}

TEST(Light, ExposureBrightensThePictureAndZeroMakesItBlack) {
  Frame frame = house_frame(50);
  double before = -1;
  for (const double exposure : {0.0, 0.3, 1.0, 2.0}) {
    frame.view.exposure = exposure;
    const double now = mean(drawn(frame)).mean();
    EXPECT_GT(now, before) << exposure;
    if (exposure == 0) {
      EXPECT_EQ(now, 0);
    }
    before = now;
  }
}

TEST(Light, SunAndSkyHaveColorsAndStrengthsOfTheirOwn) {
  Frame frame = house_frame(50);
  const Vec3 day = mean(drawn(frame));
  frame.view.sun_strength = 0;
  const Vec3 overcast = mean(drawn(frame));
  EXPECT_LT(overcast.sum(), day.sum());
  EXPECT_GT(overcast.z() / overcast.x(), day.z() / day.x()) << "the light of the sky is blue";
  frame.view.sun_strength = 1;
  frame.view.sky_strength = 0;
  frame.view.sun_color = Vec3f(3, 0, 0);
  const Vec3 red = mean(drawn(frame));
  EXPECT_GT(red.x(), 10);
  EXPECT_LT(red.y() + red.z(), 0.2 * red.x());
  frame.view.sun_strength = 0;
  EXPECT_EQ(mean(drawn(frame)).sum(), 0) << "no light is left";
}

TEST(Samples, AreTheSamePictureWithSmootherEdges) {
  const Frame frame = house_frame(50);
  const Image one = drawn(frame), many = drawn(frame, 4);
  EXPECT_EQ(drawn(frame, 4), many);
  EXPECT_LT((mean(one) - mean(many)).norm(), 1.5);
  EXPECT_LT(compare(one, many).flip_mean, 0.05);
  const Image more = drawn(frame, 16);
  EXPECT_LT(compare(more, many).flip_mean, 0.8 * compare(more, one).flip_mean);
}

TEST(Shutter, BlursMovingBodiesAlongTheirPathAndNothingElse) {
  const Frame before = ball_at({-2, 4, 0});
  Frame now = ball_at({2, 4, 0});
  now.time_s = before.time_s + 1.0 / 60;
  const Image sharp = drawn(now, 8, &before);
  EXPECT_LT(compare(sharp, drawn(now, 8)).flip_mean, 1e-9) << "the shutter does not stay open";
  now.view.shutter = 1;
  const Image blurred = drawn(now, 8, &before);
  const Image empty = drawn(ball_at({100, 4, 0}), 8);
  const auto off = [&](const Image& image, int left, int right) {
    return (mean(image, left, 60, right, 120) - mean(empty, left, 60, right, 120)).norm();
  };
  // The ball ends right of the middle and only passes through the middle.
  EXPECT_LT(off(sharp, 150, 170), 0.5);
  EXPECT_GT(off(blurred, 150, 170), 1);
  const int at = 160 + 40;
  EXPECT_LT(off(blurred, at, at + 10), off(sharp, at, at + 10));
  EXPECT_LT((mean(blurred, 0, 140) - mean(empty, 0, 140)).norm(), 0.5) << "the ground stays";
  EXPECT_LT(compare(drawn(now, 1, &before), drawn(ball_at({2, 4, 0}))).flip_mean, 0.02);
  now.bodies[0].velocity_W = Vec3(4 * 60, 0, 0);
  EXPECT_LT(compare(drawn(now, 8), blurred).flip_mean, 0.01)
      << "blurred by velocity without a frame before";
}

TEST(FrameInterval, BodiesMoveStraightAndTurnEvenlyFromTheFrameBefore) {
  Frame first = ball_at({0, 3, 0}), second = ball_at({4, 3, 0});
  second.time_s = first.time_s + 1.0 / 60;
  second.bodies[0].X_WB.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitY()));
  second.view.eye_W += Vec3(0, 2, 0);
  const FrameInterval interval = up_to(second, &first);
  const std::shared_ptr<Frame> half = between(interval, 0.5);
  EXPECT_LT((half->bodies[0].X_WB.position - Vec3(2, 3, 0)).norm(), 1e-12);
  EXPECT_NEAR(half->bodies[0].X_WB.rotation.angularDistance(Quat::Identity()), 0.2, 1e-9);
  EXPECT_EQ(half->view.eye_W, Vec3(first.view.eye_W + Vec3(0, 1, 0)));
  const Pose end = between(interval, 1)->bodies[0].X_WB, &now = second.bodies[0].X_WB;
  EXPECT_EQ(end.position, now.position);
  EXPECT_LT(end.rotation.angularDistance(now.rotation), 1e-15);
}

TEST(FrameInterval, ANewBodyIsExtrapolatedBackByItsVelocity) {
  const Frame first = ball_at({0, 3, 0});
  Frame second = ball_at({4, 3, 0});
  second.time_s = first.time_s + 0.1;
  second.bodies[0].key = second.bodies[0].previous_key = 8;
  second.bodies[0].velocity_W = Vec3(10, 0, 0);
  second.bodies[0].angular_velocity_W = Vec3(0, 4, 0);
  const std::shared_ptr<Frame> half = between(up_to(second, &first), 0.5);
  EXPECT_LT((half->bodies[0].X_WB.position - Vec3(3.5, 3, 0)).norm(), 1e-12);
  EXPECT_NEAR(half->bodies[0].X_WB.rotation.angularDistance(second.bodies[0].X_WB.rotation), 0.2,
              1e-9);
  const std::shared_ptr<Frame> alone = between(up_to(second, nullptr), 0.5);
  EXPECT_NEAR(alone->bodies[0].X_WB.position.x(), 4 - 10 * 0.5 / 60, 1e-12);
}

TEST(FrameInterval, MatchedDebrisMovesStraightAndUnmatchedDebrisStays) {
  Frame first = ball_at({0, 3, 0}), second = first;
  second.time_s = first.time_s + 1.0 / 60;
  FrameDebris chip;
  chip.radius_m = 0.1f;
  first.debris = {chip, chip};
  chip.position_W = Vec3f(1.5f, 0, 0);  // debris that moves 2 m or more is not matched
  second.debris = {chip, chip};
  second.debris[1].radius_m = 0.2f;
  const std::shared_ptr<Frame> half = between(up_to(second, &first), 0.5);
  EXPECT_EQ(half->debris[0].position_W, Vec3f(0.75f, 0, 0));
  EXPECT_EQ(half->debris[1].position_W, Vec3f(1.5f, 0, 0));
}

}  // namespace
}  // namespace sunder::render::film_test
