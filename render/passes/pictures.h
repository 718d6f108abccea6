// The pictures that paints of meshes from files have, on the GPU.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/types.h"
#include "render/gl/table.h"

namespace sunder::render {

inline constexpr std::size_t kMostPictures = 32;  ///< Further ones are shown as their colour alone.
inline constexpr int kMostPictureTexels = 1024;   ///< A side; larger ones are shown as coarsely.

/// An array texture with a layer a picture, all of one size.
class Pictures {
 public:
  /// Binds its texture to the active unit.
  explicit Pictures(const GlTable& gl);

  /// Uploads those of `paints`, in place of what was there; on the same unit. Throws InputError for
  /// what is neither PNG nor JPEG.
  void update(const std::vector<Paint>& paints);
  /// Texels (RGBA, float) of paints in pieces.vert, two a paint: its colour, and the layer of its
  /// picture counted from 1, 0: none; those of its relief and gloss likewise, how rough it is, -1:
  /// without gloss, and how much of a metal.
  std::vector<float> rows(const std::vector<Paint>& paints) const;

 private:
  /// A picture, either way up.
  struct Layer {
    Picture picture;
    bool from_below = false;
    std::optional<float> relief_scale = std::nullopt;  ///< None: it shows colours.
    bool operator==(const Layer&) const = default;
  };
  static Layer color_layer(const Paint& paint) { return {paint.picture, paint.from_below}; }
  static Layer relief_layer(const Paint& paint) {
    return {paint.relief, paint.from_below, paint.relief_scale};
  }
  static Layer gloss_layer(const Paint& paint) {
    return {paint.gloss ? paint.gloss->picture : nullptr, paint.from_below};
  }
  /// Its number from 1; 0: it is not shown.
  float layer_of(const Layer& layer) const;

  const GlTable& gl_;
  GLuint texture_ = 0;
  std::vector<Layer> layers_;
};

}  // namespace sunder::render
