// Textures of meshes from files: colour, relief and gloss.
#pragma once

#include <cstddef>
#include <optional>
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

  /// Uploads the pictures of `paints` in place of the old ones; the unit must be active. Throws
  /// InputError for a picture that is neither PNG nor JPEG.
  void update(const std::vector<Paint>& paints);
  /// Returns the texels (RGBA, float) of `paints` for pieces.vert, two per paint. First: linear
  /// colour, layer of its picture. Second: layer of its relief, layer of its gloss, roughness (-1
  /// without gloss), metalness. Layers are counted from 1; 0 stands for none.
  std::vector<float> rows(const std::vector<Paint>& paints) const;

 private:
  /// A picture as it is used in a layer.
  struct Layer {
    Picture picture;
    bool from_below = false;                           ///< True if the bottom row comes first.
    std::optional<float> relief_scale = std::nullopt;  ///< Set if the layer is a normal map.
    bool operator==(const Layer&) const = default;
  };
  static Layer color_layer(const Paint& paint) { return {paint.picture, paint.from_below}; }
  static Layer relief_layer(const Paint& paint) {
    return {paint.relief, paint.from_below, paint.relief_scale};
  }
  static Layer gloss_layer(const Paint& paint) {
    return {paint.gloss ? paint.gloss->picture : nullptr, paint.from_below};
  }
  /// Returns the number of a layer, from 1, or 0 if it is not uploaded.
  float layer_of(const Layer& layer) const;

  const GlTable& gl_;
  GLuint texture_ = 0;
  std::vector<Layer> layers_;
};

}  // namespace sunder::render
