#include "render/passes/chips.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/random.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "render/gl/objects.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {
namespace {

constexpr int kHullPoints = 9;                    // number of points whose convex hull is a chip
constexpr float kMinRadius_px = 0.3f;             // least radius, in pixels, that is drawn
constexpr float kMinCasterRadius_texels = 0.75f;  // least radius, in texels, that casts a shadow

struct ChipVertex {
  float position[3];
  float normal[3];
};

struct ChipInstance {
  float place[4];  ///< Centre relative to the eye; radius.
  float rotation[4];
  float material;
};

/// Makes a flat-shaded chip inscribed in the unit sphere: longer than wide, wider than thick.
std::vector<ChipVertex> make_chip(std::uint64_t variant) {
  Random random(17, variant);
  const Vec3 shape(1, random.uniform(0.6, 0.9), random.uniform(0.4, 0.75));
  std::vector<Vec3> points;
  double farthest = 0;
  for (int i = 0; i < kHullPoints; ++i) {
    points.push_back(random.uniform(0.8, 1) * random.direction().cwiseProduct(shape));
    farthest = std::max(farthest, points.back().norm());
  }
  for (Vec3& point : points) point /= farthest;
  const ConvexPolyhedron hull = make_hull(points);
  std::vector<ChipVertex> vertices;
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const Vec3f n = hull.faces[f].plane.normal.cast<float>();
    const auto corners = hull.face_corners(f);
    for (std::size_t c = 2; c < corners.size(); ++c) {
      for (const std::size_t corner : {std::size_t{0}, c - 1, c}) {
        const Vec3f p = hull.vertices[corners[corner]].cast<float>();
        vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
      }
    }
  }
  return vertices;
}

ChipInstance instance_of(const FrameDebris& chip, const Vec3f& center) {
  const Quatf q = chip.rotation_WD.normalized();
  return {{center.x(), center.y(), center.z(), chip.radius_m},
          {q.x(), q.y(), q.z(), q.w()},
          static_cast<float>(chip.material.value)};
}

}  // namespace

Chips::Chips(const GlTable& gl) : gl_(gl) {
  using namespace shader_sources;
  program_ =
      make_program(gl, "chips", {common_glsl, chips_vert}, {common_glsl, shadow_glsl, pieces_frag});
  shadow_program_ = make_program(gl, "chips' shadow", {common_glsl, "#define SHADOW\n", chips_vert},
                                 {common_glsl, nothing_frag});
  std::vector<ChipVertex> vertices;
  for (std::size_t v = 0; v < variants_.size(); ++v) {
    const std::vector<ChipVertex> chip = make_chip(v);
    variants_[v].first_vertex = static_cast<GLint>(vertices.size());
    variants_[v].vertices = static_cast<GLsizei>(chip.size());
    vertices.insert(vertices.end(), chip.begin(), chip.end());
  }
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &vertex_buffer_);
  gl_.GenBuffers(1, &instance_buffer_);
  gl_.BindVertexArray(vertex_array_);
  fill_buffer(gl_, GL_ARRAY_BUFFER, vertex_buffer_, vertices, GL_STATIC_DRAW);
  set_attributes(gl_, 0, sizeof(ChipVertex),
                 {{3, offsetof(ChipVertex, position)}, {3, offsetof(ChipVertex, normal)}});
  for (const GLuint attribute : {2u, 3u, 4u}) gl_.VertexAttribDivisor(attribute, 1);
}

void Chips::update(const Frame& frame, float pixels_per_radian, float shadow_texel_m) {
  const Vec3f forward = (frame.view.target_W - frame.view.eye_W).normalized().cast<float>();
  const Vec3f eye = frame.view.eye_W.cast<float>();
  std::array<std::vector<ChipInstance>, kDebrisVariants> casters, others;
  for (const FrameDebris& chip : frame.debris) {
    const Vec3f center = chip.position_W - eye;
    const float along = center.dot(forward);
    if (chip.radius_m * pixels_per_radian < kMinRadius_px * along || along < chip.radius_m)
      continue;
    auto& list = chip.radius_m > kMinCasterRadius_texels * shadow_texel_m ? casters : others;
    list[chip.variant % kDebrisVariants].push_back(instance_of(chip, center));
  }
  std::vector<ChipInstance> all;
  for (std::size_t v = 0; v < variants_.size(); ++v) {
    Variant& variant = variants_[v];
    variant.first = all.size();
    variant.casters = casters[v].size();
    all.insert(all.end(), casters[v].begin(), casters[v].end());
    all.insert(all.end(), others[v].begin(), others[v].end());
    variant.count = all.size() - variant.first;
  }
  if (all.empty()) return;
  fill_buffer(gl_, GL_ARRAY_BUFFER, instance_buffer_, all, GL_STREAM_DRAW);
}

void Chips::draw_shadows() const { draw(shadow_program_, &Variant::casters); }
void Chips::draw() const { draw(program_); }
void Chips::draw(GLuint program) const { draw(program, &Variant::count); }

void Chips::draw(GLuint program, std::size_t Variant::*count) const {
  gl_.UseProgram(program);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, instance_buffer_);
  for (const Variant& variant : variants_) {
    if (variant.*count == 0) continue;
    set_attributes(gl_, 2, sizeof(ChipInstance),
                   {{4, offsetof(ChipInstance, place)},
                    {4, offsetof(ChipInstance, rotation)},
                    {1, offsetof(ChipInstance, material)}},
                   variant.first * sizeof(ChipInstance));
    gl_.DrawArraysInstanced(GL_TRIANGLES, variant.first_vertex, variant.vertices,
                            static_cast<GLsizei>(variant.*count));
  }
}

}  // namespace sunder::render
