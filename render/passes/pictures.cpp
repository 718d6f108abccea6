#include "render/passes/pictures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "render/image/image.h"

namespace sunder::render {
namespace {

/// Where all is grey: how much higher than black white is, in parts of the picture's width.
constexpr float kHeight = 0.02f;
constexpr float kMostSteeper = 100;  ///< Paint::relief_scale, in files that nobody has seen.

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

/// The normal at a pixel, right, up in the picture and off it, which goes on at its edges.
Vec3f normal_at(const Image& image, bool heights, int x, int y) {
  const auto level = [&](int column, int row, std::size_t channel) {
    const std::size_t at =
        texel_at(image, (column + image.width) % image.width, (row + image.height) % image.height);
    return static_cast<float>(image.rgb[at + channel]) / 255;
  };
  if (heights) {
    const float steep = 0.5f * kHeight * static_cast<float>(image.width);
    return Vec3f(steep * (level(x - 1, y, 0) - level(x + 1, y, 0)),
                 steep * (level(x, y + 1, 0) - level(x, y - 1, 0)), 1);
  }
  // 128 is 0, that a flat picture is flat.
  const auto signed_level = [&](std::size_t channel) {
    return (255 * level(x, y, channel) - 128) / 127;
  };
  return Vec3f(signed_level(0), signed_level(1), std::max(signed_level(2), 0.01f));
}

/// The picture's normals along its texture coordinates, so much steeper.
Image relief_image(const Image& given, bool from_below, float scale) {
  if (!(std::abs(scale) <= kMostSteeper)) scale = kMostSteeper;
  const Vec3f steeper(scale, from_below ? scale : -scale, 1);
  const bool heights = is_grey(given);
  Image image{given.width, given.height, {}};
  image.rgb.reserve(given.rgb.size());
  for (int y = 0; y < given.height; ++y) {
    for (int x = 0; x < given.width; ++x) {
      const Vec3f n = normal_at(given, heights, x, y).cwiseProduct(steeper).normalized();
      for (const float level : n) {
        image.rgb.push_back(static_cast<std::uint8_t>(std::lround(128 + 127 * level)));
      }
    }
  }
  return image;
}

/// RGBA texels of a picture scaled to `side` x `side`: the mean of what each covers, and of its
/// nearest pixels where that is less than one; the row where texture coordinates begin comes first.
std::vector<std::uint8_t> scaled(const Image& image, int side, bool from_below) {
  std::vector<std::uint8_t> texels(4 * static_cast<std::size_t>(side) *
                                   static_cast<std::size_t>(side));
  const auto covered = [&](int texel, int pixels) {
    const int first = static_cast<int>(std::int64_t{texel} * pixels / side);
    const int end = static_cast<int>(std::int64_t{texel + 1} * pixels / side);
    return std::pair(first, std::max(end, first + 1));
  };
  for (int v = 0; v < side; ++v) {
    const auto [top, bottom] = covered(from_below ? side - 1 - v : v, image.height);
    for (int u = 0; u < side; ++u) {
      const auto [left, right] = covered(u, image.width);
      std::uint32_t sum[3] = {};
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const std::size_t at = texel_at(image, x, y);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += image.rgb[at + c];
        }
      }
      const auto count = static_cast<std::uint32_t>((bottom - top) * (right - left));
      std::uint8_t* texel =
          texels.data() + 4 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(side) +
                               static_cast<std::size_t>(u));
      for (std::size_t c = 0; c < 3; ++c) {
        texel[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
      texel[3] = 255;
    }
  }
  return texels;
}

}  // namespace

Pictures::Pictures(const GlTable& gl) : gl_(gl) {
  gl_.GenTextures(1, &texture_);
  gl_.BindTexture(GL_TEXTURE_2D_ARRAY, texture_);
  update({});
}

float Pictures::layer_of(const Layer& layer) const {
  const auto found = std::find(layers_.begin(), layers_.end(), layer);
  const bool shown = layer.picture && found != layers_.end();
  return shown ? static_cast<float>(found - layers_.begin() + 1) : 0.0f;
}

void Pictures::update(const std::vector<Paint>& paints) {
  layers_.clear();
  std::vector<Image> images;
  int largest = 1;
  const auto add = [&](const Layer& layer) {
    if (!layer.picture || layers_.size() == kMostPictures || layer_of(layer) > 0) return;
    images.push_back(decode_picture(*layer.picture));
    if (layer.relief_scale) {
      images.back() = relief_image(images.back(), layer.from_below, *layer.relief_scale);
    }
    layers_.push_back(layer);
    largest = std::max({largest, images.back().width, images.back().height});
  };
  for (const Paint& paint : paints) add(color_layer(paint));
  for (const Paint& paint : paints) add(relief_layer(paint));
  for (const Paint& paint : paints) add(gloss_layer(paint));
  const auto wanted = static_cast<int>(std::bit_ceil(static_cast<unsigned>(largest)));
  const int side = std::min(wanted, kMostPictureTexels);
  std::vector<std::uint8_t> texels(images.empty() ? 4 : 0);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::vector<std::uint8_t> layer = scaled(images[i], side, layers_[i].from_below);
    texels.insert(texels.end(), layer.begin(), layer.end());
  }
  gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, side, side,
                 static_cast<GLsizei>(std::max<std::size_t>(images.size(), 1)), 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, texels.data());
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.GenerateMipmap(GL_TEXTURE_2D_ARRAY);
}

std::vector<float> Pictures::rows(const std::vector<Paint>& paints) const {
  std::vector<float> texels;
  for (const Paint& paint : paints) {
    texels.insert(
        texels.end(),
        {paint.color.x(), paint.color.y(), paint.color.z(), layer_of(color_layer(paint)),
         layer_of(relief_layer(paint)), layer_of(gloss_layer(paint)),
         paint.gloss ? paint.gloss->roughness : -1, paint.gloss ? paint.gloss->metallic : 0});
  }
  return texels;
}

}  // namespace sunder::render
