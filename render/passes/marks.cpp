#include "render/passes/marks.h"

#include <cstddef>

#include "render/gl/objects.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {
namespace {

struct MarkVertex {
  float position[3];
  float normal[3];  ///< 0 for an edge.
};

struct MarkInstance {
  float center[3];  ///< Relative to the eye.
  float axes[9];
  float color[4];  ///< Colour; opacity where hidden.
};

std::vector<MarkVertex> make_octahedron() {
  std::vector<MarkVertex> vertices;
  for (int face = 0; face < 8; ++face) {
    const Vec3f signs((face & 1) != 0 ? 1.f : -1.f, (face & 2) != 0 ? 1.f : -1.f,
                      (face & 4) != 0 ? 1.f : -1.f);
    const bool outward = signs.prod() > 0;
    for (const int axis : {0, outward ? 1 : 2, outward ? 2 : 1}) {
      MarkVertex& v = vertices.emplace_back(MarkVertex{{0, 0, 0}, {0, 0, 0}});
      v.position[axis] = signs[axis];
      for (int i = 0; i < 3; ++i) v.normal[i] = signs[i];
    }
  }
  return vertices;
}

std::vector<MarkVertex> make_edges() {
  std::vector<MarkVertex> vertices;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 8; ++corner) {
      MarkVertex& v = vertices.emplace_back(MarkVertex{{0, 0, 0}, {0, 0, 0}});
      for (int i = 0; i < 3; ++i)  // this axis first, so that pairs of corners are edges along it
        v.position[(axis + i) % 3] = (corner >> i & 1) != 0 ? 1.f : -1.f;
    }
  }
  return vertices;
}

MarkInstance instance_of(const Mark& mark, const Vec3& eye_W) {
  const Vec3f center = (mark.center_W.cast<double>() - eye_W).cast<float>();
  MarkInstance made{{center.x(), center.y(), center.z()},
                    {},
                    {mark.color.x(), mark.color.y(), mark.color.z(), mark.hidden_opacity}};
  for (int i = 0; i < 9; ++i) made.axes[i] = mark.half_axes_W(i % 3, i / 3);
  return made;
}

}  // namespace

Marks::Marks(const GlTable& gl) : gl_(gl) {
  using namespace shader_sources;
  program_ = make_program(gl, "marks", {common_glsl, marks_vert}, {common_glsl, marks_frag});
  hidden_program_ = make_program(gl, "hidden marks", {common_glsl, marks_vert},
                                 {common_glsl, "#define HIDDEN\n", marks_frag});
  std::vector<MarkVertex> vertices = make_octahedron();
  spindles_.vertices = boxes_.first_vertex = static_cast<GLint>(vertices.size());
  const std::vector<MarkVertex> edges = make_edges();
  boxes_.kind = GL_LINES;
  boxes_.vertices = static_cast<GLsizei>(edges.size());
  vertices.insert(vertices.end(), edges.begin(), edges.end());
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &vertex_buffer_);
  gl_.GenBuffers(1, &instance_buffer_);
  gl_.BindVertexArray(vertex_array_);
  fill_buffer(gl_, GL_ARRAY_BUFFER, vertex_buffer_, vertices, GL_STATIC_DRAW);
  set_attributes(gl_, 0, sizeof(MarkVertex),
                 {{3, offsetof(MarkVertex, position)}, {3, offsetof(MarkVertex, normal)}});
  for (const GLuint attribute : {2u, 3u, 4u, 5u, 6u}) gl_.VertexAttribDivisor(attribute, 1);
}

void Marks::update(const MarkList& marks, const Vec3& eye_W) {
  std::vector<MarkInstance> instances;
  const auto add = [&](Shape& shape, const std::vector<Mark>& list) {
    shape.first = instances.size();
    shape.count = static_cast<GLsizei>(list.size());
    for (const Mark& mark : list) instances.push_back(instance_of(mark, eye_W));
  };
  add(spindles_, marks.spindles);
  add(boxes_, marks.boxes);
  if (any()) fill_buffer(gl_, GL_ARRAY_BUFFER, instance_buffer_, instances, GL_STREAM_DRAW);
}

void Marks::draw() const {
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.DepthMask(GL_FALSE);
  gl_.DepthFunc(GL_GREATER);
  draw(hidden_program_);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_LESS);
  gl_.Disable(GL_BLEND);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  draw(program_);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Marks::draw(GLuint program) const {
  gl_.UseProgram(program);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, instance_buffer_);
  for (const Shape& shape : {spindles_, boxes_}) {
    if (shape.count == 0) continue;
    set_attributes(gl_, 2, sizeof(MarkInstance),
                   {{3, offsetof(MarkInstance, center)},
                    {3, offsetof(MarkInstance, axes)},
                    {3, offsetof(MarkInstance, axes) + 3 * sizeof(float)},
                    {3, offsetof(MarkInstance, axes) + 6 * sizeof(float)},
                    {4, offsetof(MarkInstance, color)}},
                   shape.first * sizeof(MarkInstance));
    gl_.DrawArraysInstanced(shape.kind, shape.first_vertex, shape.vertices, shape.count);
  }
}

}  // namespace sunder::render
