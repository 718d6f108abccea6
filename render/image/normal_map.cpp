#include "render/image/normal_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sunder::render {
namespace {

/// Height of white above black in a height map, as a fraction of the width of the picture.
constexpr float kReliefHeight = 0.02f;
/// Greatest plausible Appearance::normal_scale; a greater one in a file counts as 1.
constexpr float kMaxReliefScale = 100;

std::size_t texel_at(const Image& image, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(x));
}

bool is_grey(const Image& image) {
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    if (image.rgb[i] != image.rgb[i + 1] || image.rgb[i] != image.rgb[i + 2]) return false;
  }
  return true;
}

/// Returns the normal at a pixel: right, up in the picture, and out of it. The picture is periodic.
Vec3f normal_at(const Image& image, bool heights, int x, int y) {
  const auto level = [&](int column, int row, std::size_t channel) {
    const std::size_t at =
        texel_at(image, (column + image.width) % image.width, (row + image.height) % image.height);
    return static_cast<float>(image.rgb[at + channel]) / 255;
  };
  if (heights) {
    const float steep = 0.5f * kReliefHeight * static_cast<float>(image.width);
    return Vec3f(steep * (level(x - 1, y, 0) - level(x + 1, y, 0)),
                 steep * (level(x, y + 1, 0) - level(x, y - 1, 0)), 1);
  }
  // 128 maps to 0, so that a uniform picture is flat.
  const auto signed_level = [&](std::size_t channel) {
    return (255 * level(x, y, channel) - 128) / 127;
  };
  return Vec3f(signed_level(0), signed_level(1), std::max(signed_level(2), 0.01f));
}

}  // namespace

Image make_normal_map(const Image& relief, float scale_along, float scale_up) {
  const auto limited = [](float scale) {
    return std::abs(scale) <= kMaxReliefScale ? scale : 1.0f;
  };
  const Vec3f scale(limited(scale_along), limited(scale_up), 1);
  const bool heights = is_grey(relief);
  Image image{relief.width, relief.height, {}};
  image.rgb.reserve(relief.rgb.size());
  for (int y = 0; y < relief.height; ++y) {
    for (int x = 0; x < relief.width; ++x) {
      const Vec3f n = normal_at(relief, heights, x, y).cwiseProduct(scale).normalized();
      for (const float level : n) {
        image.rgb.push_back(static_cast<std::uint8_t>(std::lround(128 + 127 * level)));
      }
    }
  }
  return image;
}

EncodedImage as_normal_map(const EncodedImage& relief) {
  const Image image = decode_picture(*relief);
  if (!is_grey(image)) return relief;
  const std::vector<std::uint8_t> png = encode_png(make_normal_map(image, 1, 1));
  const auto* begin = reinterpret_cast<const std::byte*>(png.data());
  return std::make_shared<const std::vector<std::byte>>(begin, begin + png.size());
}

}  // namespace sunder::render
