// Tests of image comparison with the faults that its thresholds are calibrated on.
#include "render/image/compare.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

const Frame& house() {
  static const Frame frame = house_frame(300);
  return frame;
}

Image drawn(const Frame& frame) {
  static Renderer renderer({.width = 640, .height = 360});
  return renderer.draw(frame);
}

const Image& reference() {
  static const Image image = drawn(house());
  return image;
}

template <class Change>
Image changed(const Change& change) {
  Image image = reference();
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<std::uint8_t>(std::clamp(change(i, int{image.rgb[i]}), 0, 255));
  }
  return image;
}

Box bounds_of(const Mesh& mesh) {
  Box box;
  for (const Mesh::Vertex& v : mesh.vertices) box.extend(Vec3(v.position.cast<double>()));
  return box;
}

std::size_t at(int x, int y) { return 3 * static_cast<std::size_t>(y * reference().width + x); }

TEST(Compare, APicturePassesAgainstItself) {
  const Difference difference = compare(reference(), reference());
  EXPECT_TRUE(difference.same_bytes);
  EXPECT_TRUE(difference.passes({}));
}

TEST(Compare, NoiseOfOtherProcessorsPasses) {
  Random random(5);
  const Image noisy =
      changed([&](std::size_t, int v) { return v + (random.below(20) == 0 ? 1 : 0); });
  const Difference difference = compare(reference(), noisy);
  EXPECT_FALSE(difference.same_bytes);
  EXPECT_TRUE(difference.passes({})) << difference.flip_mean;
}

TEST(Compare, AFaultOfSixBySixPixelsFails) {
  Image image = reference();
  for (int y = 100; y < 106; ++y) {
    for (int x = 200; x < 206; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint8_t& value = image.rgb[at(x, y) + c];
        value = static_cast<std::uint8_t>(value < 128 ? value + 60 : value - 60);
      }
    }
  }
  const Difference difference = compare(reference(), image);
  EXPECT_EQ(difference.worst_window_pixels, 36);
  EXPECT_LE(difference.worst_window_x, 200);
  EXPECT_GE(difference.worst_window_x + 32, 206);
  EXPECT_LT(difference.flip_mean, 0.01) << "a mean over the picture alone would miss it";
  EXPECT_FALSE(difference.passes({}));
}

TEST(Compare, OtherAlphaFailsAndColorsThatNobodySeesDoNot) {
  Image clear = reference(), solid = reference(), hidden = reference();
  const std::size_t pixels = clear.rgb.size() / 3;
  clear.alpha.assign(pixels, 128);
  solid.alpha.assign(pixels, 255);
  hidden.alpha.assign(pixels, 0);
  EXPECT_FALSE(compare(clear, solid).passes({}));
  EXPECT_FALSE(compare(clear, reference()).passes({})) << "without alpha all is covered";
  EXPECT_FALSE(compare(reference(), clear).passes({}));
  EXPECT_EQ(compare(solid, reference()).share_of({}), 0) << "before any background";
  Image other = hidden;
  for (std::uint8_t& level : other.rgb) level = static_cast<std::uint8_t>(255 - level);
  EXPECT_TRUE(compare(hidden, other).passes({}));
}

TEST(Compare, TwoPercentMoreBrightnessFails) {
  const Image image = changed([](std::size_t, int v) { return (v * 102 + 50) / 100; });
  const Difference difference = compare(reference(), image);
  EXPECT_LE(difference.worst_window_pixels, 24) << "a count of pixels alone would miss it";
  EXPECT_FALSE(difference.passes({})) << difference.flip_mean;
}

TEST(Compare, AShiftByOnePixelFails) {
  const Image image =
      changed([](std::size_t i, int v) { return i < 3 ? v : int{reference().rgb[i - 3]}; });
  EXPECT_FALSE(compare(reference(), image).passes({}));
}

TEST(Compare, AMissingPieceFails) {
  Frame frame = house();
  const auto is_fist_sized = [&](const Instance& instance) {
    const Box box = bounds_of(*(*frame.meshes)[instance.mesh.value]);
    return box.extent().maxCoeff() > 0.3 && box.extent().maxCoeff() < 0.5;
  };
  const auto piece = std::find_if(frame.instances.begin(), frame.instances.end(), is_fist_sized);
  ASSERT_NE(piece, frame.instances.end());
  frame.instances.erase(piece);
  const Difference difference = compare(reference(), drawn(frame));
  EXPECT_FALSE(difference.passes({})) << difference.worst_window_pixels;
}

TEST(Compare, AnotherSizeFails) {
  Image image = reference();
  image.height -= 1;
  image.rgb.resize(at(0, image.height));
  const Difference difference = compare(reference(), image);
  EXPECT_FALSE(difference.same_size);
  EXPECT_FALSE(difference.passes({}));
}

TEST(Compare, FlipIsNearZeroForNearlyEqualPicturesAndNearOneForOpposites) {
  Image black{64, 64, std::vector<std::uint8_t>(3 * 64 * 64, 0)};
  Image white{64, 64, std::vector<std::uint8_t>(3 * 64 * 64, 255)};
  Image nearly = black;
  nearly.rgb[0] = 1;
  EXPECT_LT(compare(black, nearly).flip_mean, 1e-4);
  EXPECT_GT(compare(black, white).flip_mean, 0.9);
}

}  // namespace
}  // namespace sunder::render
