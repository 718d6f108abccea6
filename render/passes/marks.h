// Drawing of the marks of view modes: plain shapes, which show faintly where they are hidden.
#pragma once

#include <vector>

#include "engine/base/types.h"
#include "render/gl/table.h"

namespace sunder::render {

/// A shape scaled along three axes.
struct Mark {
  Vec3f center_W = Vec3f::Zero();
  Mat3f half_axes_W = Mat3f::Identity();  ///< Half axes in columns.
  Vec3f color = Vec3f::Ones();            ///< Linear RGB.
  float hidden_opacity = 0.5f;            ///< Opacity where the mark is hidden, 0 to 1.
};
struct MarkList {
  std::vector<Mark> spindles;  ///< Solid octahedra.
  std::vector<Mark> boxes;     ///< Edges of boxes.

  bool empty() const { return spindles.empty() && boxes.empty(); }
};

class Marks {
 public:
  explicit Marks(const GlTable& gl);

  void update(const MarkList& marks, const Vec3& eye_W);
  bool any() const { return spindles_.count + boxes_.count > 0; }
  /// Draws into the bound framebuffer and its depths: hidden parts first, then visible ones.
  void draw() const;

 private:
  struct Shape {
    GLenum kind = GL_TRIANGLES;
    GLint first_vertex = 0;
    GLsizei vertices = 0;
    std::size_t first = 0;  ///< First instance.
    GLsizei count = 0;
  };

  void draw(GLuint program) const;

  const GlTable& gl_;
  GLuint program_ = 0;
  GLuint hidden_program_ = 0;
  GLuint vertex_array_ = 0;
  GLuint vertex_buffer_ = 0;
  GLuint instance_buffer_ = 0;
  Shape spindles_, boxes_;
};

}  // namespace sunder::render
