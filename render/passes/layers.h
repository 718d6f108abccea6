// What is known of each pixel besides its colour: how far it is, which way it faces, of what it is.
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

/// Throws InputError for a name that is not in kLayers.
void check_layers(std::span<const std::string> names);

/// Draws layers, each in a pass of its own over what is solid: glass is, dust is not.
class Layers {
 public:
  Layers(const GlTable& gl, const std::vector<std::string>& names, int width, int height);
  /// Of the frame that `pieces` and `chips` were updated with; those are changed.
  std::vector<Layer> draw(const Frame& frame, Pieces& pieces, const Chips& chips);

 private:
  struct Pass {
    std::string name;
    GLuint pieces = 0, chips = 0, ground = 0;
  };

  void draw(const Pass& pass, Pieces& pieces, const Chips& chips);
  DeepImage read(int channels) const;
  std::vector<float> read_metres() const;
  DeepImage depth_image(const View& view);

  const GlTable& gl_;
  int width_, height_;
  GLuint framebuffer_ = 0;
  GLuint depth_framebuffer_ = 0;  ///< Of floats.
  std::optional<double> far_m_;   ///< White of the layer of depth, for all pictures.
  GLuint empty_vertex_array_ = 0;
  std::vector<Pass> passes_;
};

}  // namespace sunder::render
