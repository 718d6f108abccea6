// Dust on the GPU: soft sprites, lit by sun and sky, at half the picture's resolution.
#pragma once

#include "engine/model/frame.h"
#include "render/gl/table.h"

namespace sunder::render {

class Puffs {
 public:
  explicit Puffs(const GlTable& gl);

  /// Uploads the frame's dust, farthest first; what is behind the eye is left out.
  void update(const Frame& frame);
  bool any() const { return count_ > 0; }
  /// Light and the part of what is behind that it hides, premultiplied, over what is there.
  void draw() const;

 private:
  const GlTable& gl_;
  GLuint program_ = 0;
  GLuint vertex_array_ = 0;
  GLuint buffer_ = 0;
  GLsizei count_ = 0;
};

}  // namespace sunder::render
