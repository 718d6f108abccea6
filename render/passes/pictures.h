// Textures of meshes from files: colour, relief and gloss.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/types.h"
#include "render/gl/table.h"

namespace sunder::render {

/// Greatest number of textures; surfaces with further ones show their colour alone.
inline constexpr std::size_t kMaxPictures = 32;
/// Greatest width and height of a texture, in texels; larger pictures are scaled down.
inline constexpr int kMaxPictureSide = 1024;

/// An array texture with one layer per picture, all of one size.
class Pictures {
 public:
  /// Makes the texture and binds it to the active unit.
  explicit Pictures(const GlTable& gl);

  /// Uploads the images of `appearances` in place of the old ones; the unit must be active. Throws
  /// InputError for a picture that is neither PNG nor JPEG.
  void update(const std::vector<Appearance>& appearances);
  /// Returns the texels (RGBA, float) of `appearances` for pieces.vert, two per appearance. First:
  /// linear colour, layer of its picture. Second: layer of its relief, layer of its gloss,
  /// roughness (-1 without gloss), metalness. Layers are counted from 1; 0 stands for none.
  std::vector<float> rows(const std::vector<Appearance>& appearances) const;
  /// Returns warnings for pictures of the last update() that are left out or scaled down.
  std::vector<std::string> warnings() const;

 private:
  /// A picture as it is used in a layer.
  struct Layer {
    EncodedImage picture;
    bool v_from_bottom = false;                        ///< True if the bottom row comes first.
    std::optional<float> normal_scale = std::nullopt;  ///< Set if the layer is a normal map.
    bool operator==(const Layer&) const = default;
  };
  static Layer color_layer(const Appearance& appearance) {
    return {appearance.picture, appearance.v_from_bottom};
  }
  static Layer relief_layer(const Appearance& appearance) {
    return {appearance.relief, appearance.v_from_bottom, appearance.normal_scale};
  }
  static Layer gloss_layer(const Appearance& appearance) {
    return {appearance.gloss ? appearance.gloss->picture : nullptr, appearance.v_from_bottom};
  }
  /// Returns the number of a layer, from 1, or 0 if it is not uploaded.
  float layer_of(const Layer& layer) const;

  const GlTable& gl_;
  GLuint texture_ = 0;
  std::vector<Layer> layers_;
  std::vector<Layer> left_out_;  ///< Beyond kMaxPictures; each once.
  std::size_t scaled_down_ = 0;  ///< Number of layers whose picture is larger than the texture.
};

}  // namespace sunder::render
