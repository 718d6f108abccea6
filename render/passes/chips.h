// Debris on the GPU: a handful of chip meshes, drawn many times each.
#pragma once

#include <array>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "render/gl/table.h"

namespace sunder::render {

class Chips {
 public:
  explicit Chips(const GlTable& gl);

  /// Uploads where the frame's debris is; what is behind the eye or far below a pixel is left out.
  /// `shadow_texel_m`: smaller chips cast no shadow.
  void update(const Frame& frame, float pixels_a_radian, float shadow_texel_m);
  /// Into the sun's shadow map.
  void draw_shadows() const;
  void draw() const;
  /// The same, by another program.
  void draw(GLuint program) const;

 private:
  struct Variant {
    GLint first_vertex = 0;
    GLsizei vertices = 0;
    std::size_t first = 0;    ///< Of the instances.
    std::size_t casters = 0;  ///< The first so many cast a shadow.
    std::size_t count = 0;
  };

  void draw(GLuint program, std::size_t Variant::*count) const;

  const GlTable& gl_;
  GLuint program_ = 0;
  GLuint shadow_program_ = 0;
  GLuint vertex_array_ = 0;
  GLuint vertex_buffer_ = 0;
  GLuint instance_buffer_ = 0;
  std::array<Variant, kDebrisVariants> variants_;
};

}  // namespace sunder::render
