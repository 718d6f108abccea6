// Data layers of an image: depth, normal and body of each pixel.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/gl/objects.h"
#include "render/image/image.h"
#include "render/passes/chips.h"
#include "render/passes/pieces.h"

namespace sunder::render {

inline constexpr const char* kLayers = "depth | depth_m | normals | ids";

/// Throws InputError if a name is not in kLayers.
void check_layers(std::span<const std::string> names);

/// Draws layers, each in its own pass over solid surfaces, glass included, without dust.
class Layers {
 public:
  Layers(const GlTable& gl, const std::vector<std::string>& names, int width, int height);
  /// Draws the layers of the frame that `pieces` and `chips` were updated with. Overwrites the
  /// materials in the slots of `pieces`.
  std::vector<Layer> draw(const Frame& frame, Pieces& pieces, const Chips& chips);

 private:
  struct Pass {
    std::string name;
    GLuint pieces = 0, chips = 0, ground = 0;
  };

  void draw(const Pass& pass, Pieces& pieces, const Chips& chips);
  Image16 read(int channels) const;
  std::vector<float> read_metres() const;
  Image16 depth_image(const View& view);

  const GlTable& gl_;
  int width_, height_;
  GLuint framebuffer_ = 0;
  GLuint depth_framebuffer_ = 0;  ///< Framebuffer of floats.
  std::optional<double> far_m_;   ///< Depth of white in layer "depth", set by the first image.
  GLuint empty_vertex_array_ = 0;
  std::vector<Pass> passes_;
};

}  // namespace sunder::render
