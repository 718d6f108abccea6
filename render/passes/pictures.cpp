#include "render/passes/pictures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "render/image/image.h"
#include "render/image/normal_map.h"

namespace sunder::render {
namespace {

/// Returns the RGBA texels of a picture scaled to `side` x `side` by the mean of the pixels that
/// each texel covers, at least one. The row of texture coordinate v = 0 comes first.
std::vector<std::uint8_t> scaled(const Image& image, int side, bool v_from_bottom) {
  std::vector<std::uint8_t> texels(4 * static_cast<std::size_t>(side) *
                                   static_cast<std::size_t>(side));
  const auto covered = [&](int texel, int pixels) {
    const int first = static_cast<int>(std::int64_t{texel} * pixels / side);
    const int end = static_cast<int>(std::int64_t{texel + 1} * pixels / side);
    return std::pair(first, std::max(end, first + 1));
  };
  for (int v = 0; v < side; ++v) {
    const auto [top, bottom] = covered(v_from_bottom ? side - 1 - v : v, image.height);
    for (int u = 0; u < side; ++u) {
      const auto [left, right] = covered(u, image.width);
      std::uint32_t sum[3] = {};
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const std::size_t at =
              3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(x));
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

void Pictures::update(const std::vector<Appearance>& appearances) {
  layers_.clear();
  left_out_.clear();
  scaled_down_ = 0;
  std::vector<Image> images;
  int largest = 1;
  const auto add = [&](const Layer& layer) {
    if (!layer.picture || layer_of(layer) > 0) return;
    if (layers_.size() == kMaxPictures) {
      if (std::ranges::find(left_out_, layer) == left_out_.end()) left_out_.push_back(layer);
      return;
    }
    images.push_back(decode_picture(*layer.picture));
    if (layer.normal_scale) {
      const float scale = *layer.normal_scale;
      images.back() = make_normal_map(images.back(), scale, layer.v_from_bottom ? scale : -scale);
    }
    layers_.push_back(layer);
    const int longest = std::max(images.back().width, images.back().height);
    if (longest > kMaxPictureSide) ++scaled_down_;
    largest = std::max(largest, longest);
  };
  for (const Appearance& appearance : appearances) add(color_layer(appearance));
  for (const Appearance& appearance : appearances) add(relief_layer(appearance));
  for (const Appearance& appearance : appearances) add(gloss_layer(appearance));
  const auto wanted = static_cast<int>(std::bit_ceil(static_cast<unsigned>(largest)));
  const int side = std::min(wanted, kMaxPictureSide);
  std::vector<std::uint8_t> texels(images.empty() ? 4 : 0);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::vector<std::uint8_t> layer = scaled(images[i], side, layers_[i].v_from_bottom);
    texels.insert(texels.end(), layer.begin(), layer.end());
  }
  gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, side, side,
                 static_cast<GLsizei>(std::max<std::size_t>(images.size(), 1)), 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, texels.data());
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.GenerateMipmap(GL_TEXTURE_2D_ARRAY);
}

std::vector<std::string> Pictures::warnings() const {
  std::vector<std::string> all;
  const auto count = [](std::size_t n) {
    return std::to_string(n) + (n == 1 ? " texture" : " textures");
  };
  if (!left_out_.empty())
    all.push_back(count(left_out_.size()) + " of meshes beyond the first " +
                  std::to_string(kMaxPictures) +
                  " are not drawn: their faces have a plain colour; use fewer pictures");
  if (scaled_down_ > 0)
    all.push_back(count(scaled_down_) + " of meshes larger than " +
                  std::to_string(kMaxPictureSide) + " pixels are scaled down to that size");
  return all;
}

std::vector<float> Pictures::rows(const std::vector<Appearance>& appearances) const {
  std::vector<float> texels;
  for (const Appearance& appearance : appearances) {
    texels.insert(
        texels.end(),
        {appearance.color.x(), appearance.color.y(), appearance.color.z(),
         layer_of(color_layer(appearance)), layer_of(relief_layer(appearance)),
         layer_of(gloss_layer(appearance)), appearance.gloss ? appearance.gloss->roughness : -1,
         appearance.gloss ? appearance.gloss->metallic : 0});
  }
  return texels;
}

}  // namespace sunder::render
