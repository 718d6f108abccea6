// Tests of FXAA: slanted edges become smoother, everything else stays unchanged.
#include "render/image/antialias.h"

#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

namespace sunder::render {
namespace {

constexpr int kSide = 64;

std::uint32_t grey(int level) { return 0x01010101u * static_cast<std::uint32_t>(level); }

/// Returns an image that is white where y < slope * x + 10, and black elsewhere.
std::vector<std::uint32_t> slanted_edge(double slope) {
  std::vector<std::uint32_t> pixels;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) pixels.push_back(grey(y < slope * x + 10 ? 255 : 0));
  }
  return pixels;
}

/// Returns the mean difference from the edge's true coverage over the picture, from 0 to 255.
double error_of(const Image& image, double slope) {
  double sum = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      double covered = 0;
      for (int s = 0; s < 64; ++s) {
        const double sub_x = x - 0.5 + (s % 8 + 0.5) / 8;
        const double sub_y = y - 0.5 + (s / 8 + 0.5) / 8;
        covered += sub_y < slope * sub_x + 10 ? 1.0 / 64 : 0.0;
      }
      const auto at = static_cast<std::size_t>(3 * (y * kSide + x));
      sum += std::abs(255 * covered - image.rgb[at]);
    }
  }
  return sum / (kSide * kSide);
}

TEST(Antialias, AFlatPictureIsUntouched) {
  const Image image = apply_fxaa(std::vector<std::uint32_t>(kSide * kSide, grey(90)), kSide, kSide);
  for (const std::uint8_t value : image.rgb) ASSERT_EQ(value, 90);
}

TEST(Antialias, SlantedEdgesComeCloserToTheirTrueCoverage) {
  for (const double slope : {0.12, 0.3, 0.7}) {
    const std::vector<std::uint32_t> pixels = slanted_edge(slope);
    Image raw{kSide, kSide, {}};
    for (const std::uint32_t pixel : pixels) {
      raw.rgb.insert(raw.rgb.end(), 3, static_cast<std::uint8_t>(pixel & 255));
    }
    const Image smooth = apply_fxaa(pixels, kSide, kSide);
    EXPECT_LT(error_of(smooth, slope), 0.6 * error_of(raw, slope)) << "slope " << slope;
  }
}

TEST(Antialias, AStraightEdgeStaysSharp) {
  std::vector<std::uint32_t> pixels;
  for (int i = 0; i < kSide * kSide; ++i) pixels.push_back(grey(i / kSide < kSide / 2 ? 200 : 20));
  const Image image = apply_fxaa(pixels, kSide, kSide);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_NEAR(image.rgb[3 * i], pixels[i] & 255, 8) << "a straight edge was softened";
  }
}

}  // namespace
}  // namespace sunder::render
