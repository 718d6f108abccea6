// Drawing of dust: soft sprites, lit by sun and sky, at half the resolution of the image.
#pragma once

#include "engine/model/frame.h"
#include "render/gl/table.h"

namespace sunder::render {

class Puffs {
 public:
  explicit Puffs(const GlTable& gl);

  /// Uploads the dust of a frame, farthest first, without the puffs behind the eye.
  void update(const Frame& frame);
  bool any() const { return count_ > 0; }
  /// Draws into the bound framebuffer, with premultiplied alpha.
  void draw() const;

 private:
  const GlTable& gl_;
  GLuint program_ = 0;
  GLuint vertex_array_ = 0;
  GLuint buffer_ = 0;
  GLsizei count_ = 0;
};

}  // namespace sunder::render
