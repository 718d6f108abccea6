// The pictures that paints of meshes from files have, on the GPU.
#pragma once

#include <cstddef>
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
  /// Texels (RGBA, float) of paints in pieces.vert, one a paint: its colour, and the layer of its
  /// picture counted from 1; 0: none.
  std::vector<float> rows(const std::vector<Paint>& paints) const;

 private:
  const GlTable& gl_;
  GLuint texture_ = 0;
  std::vector<Paint> layers_;  ///< The first paint of each picture, either way up.
};

}  // namespace sunder::render
