#include "render/passes/puffs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "render/gl/objects.h"
#include "render/shaders/shader_sources.h"

namespace sunder::render {
namespace {

struct PuffInstance {
  float place[4];  ///< Centre relative to the eye; radius.
  float look[4];   ///< Cosine and sine of the rotation in the image; opacity; material.
};

}  // namespace

Puffs::Puffs(const GlTable& gl) : gl_(gl) {
  using namespace shader_sources;
  program_ =
      make_program(gl, "puffs", {common_glsl, shadow_glsl, puffs_vert}, {common_glsl, puffs_frag});
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &buffer_);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  set_attributes(gl_, 0, sizeof(PuffInstance),
                 {{4, offsetof(PuffInstance, place)}, {4, offsetof(PuffInstance, look)}});
  for (const GLuint attribute : {0u, 1u}) gl_.VertexAttribDivisor(attribute, 1);
}

void Puffs::update(const Frame& frame) {
  const Vec3f forward = (frame.view.target_W - frame.view.eye_W).normalized().cast<float>();
  const Vec3f sky = std::abs(forward.y()) < 0.999f ? Vec3f::UnitY() : Vec3f::UnitZ();
  const Vec3f right = forward.cross(sky).normalized();
  const Vec3f up = right.cross(forward);
  const Vec3f eye = frame.view.eye_W.cast<float>();
  struct Placed {
    float along;
    std::uint32_t puff;
  };
  std::vector<Placed> order;
  for (std::uint32_t i = 0; i < frame.dust.size(); ++i) {
    const FrameDust& puff = frame.dust[i];
    const float along = (puff.position_W - eye).dot(forward);
    if (along > 0.05f && puff.opacity > 0) order.push_back({along, i});
  }
  std::sort(order.begin(), order.end(), [](const Placed& a, const Placed& b) {
    return a.along != b.along ? a.along > b.along : a.puff < b.puff;
  });
  std::vector<PuffInstance> instances;
  for (const Placed& placed : order) {
    const FrameDust& puff = frame.dust[placed.puff];
    const Vec3f center = puff.position_W - eye;
    const Vec3f axis = puff.rotation_WD.normalized() * Vec3f::UnitX();
    float c = axis.dot(right), s = axis.dot(up);
    const float length = std::sqrt(c * c + s * s);
    c = length > 0.01f ? c / length : 1;
    s = length > 0.01f ? s / length : 0;
    instances.push_back({{center.x(), center.y(), center.z(), puff.radius_m},
                         {c, s, puff.opacity, static_cast<float>(puff.material.value)}});
  }
  count_ = static_cast<GLsizei>(instances.size());
  if (count_ == 0) return;
  fill_buffer(gl_, GL_ARRAY_BUFFER, buffer_, instances, GL_STREAM_DRAW);
}

void Puffs::draw() const {
  gl_.UseProgram(program_);
  gl_.BindVertexArray(vertex_array_);
  gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
}

}  // namespace sunder::render
