// Drawing of debris: instances of a few chip meshes.
#pragma once

#include <array>

#include "engine/model/frame.h"
#include "engine/model/particles.h"
#include "render/gl/table.h"

namespace sunder::render {

class Chips {
 public:
  explicit Chips(const GlTable& gl);

  /// Uploads the debris of a frame, without chips behind the eye or far smaller than a pixel. Chips
  /// smaller than about `shadow_texel_m` cast no shadow.
  void update(const Frame& frame, float pixels_per_radian, float shadow_texel_m);
  /// Draws into the shadow map of the sun.
  void draw_shadows() const;
  void draw() const;
  /// Draws with another program.
  void draw(GLuint program) const;

 private:
  struct Variant {
    GLint first_vertex = 0;
    GLsizei vertices = 0;
    std::size_t first = 0;    ///< First instance.
    std::size_t casters = 0;  ///< Number of instances, from the first on, that cast a shadow.
    std::size_t count = 0;    ///< Number of instances.
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
