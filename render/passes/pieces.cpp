#include "render/passes/pieces.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "engine/base/check.h"
#include "render/gl/objects.h"

namespace sunder::render {
namespace {

constexpr std::size_t kFloatsPerSlot = 16;
constexpr float kLarge_m = 0.25f;  // radius

struct GpuVertex {
  float position[3];
  float normal[3];
  std::uint32_t piece;  ///< slot * 2 + interior
  float uv[2];
  std::uint32_t paint;  ///< From 1; 0: none.
};

GLsizeiptr bytes(std::size_t count, std::size_t size) {
  return static_cast<GLsizeiptr>(count * size);
}

Pieces::Group group_of(const Material& material) {
  switch (material.surface.texture) {
    case Texture::kGlass:
      return Pieces::Group::kGlass;
    case Texture::kMetal:
      return Pieces::Group::kShiny;
    default:
      return Pieces::Group::kMatte;
  }
}

}  // namespace

Pieces::Pieces(const GlTable& gl) : gl_(gl) {
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &vertex_buffer_);
  gl_.GenBuffers(1, &index_buffer_);
  gl_.GenBuffers(1, &slot_buffer_);
  gl_.GenTextures(1, &slot_texture_);

  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  set_attributes(gl_, 0, sizeof(GpuVertex),
                 {{3, offsetof(GpuVertex, position)}, {3, offsetof(GpuVertex, normal)}});
  gl_.EnableVertexAttribArray(2);
  gl_.VertexAttribIPointer(2, 1, GL_UNSIGNED_INT, sizeof(GpuVertex),
                           buffer_offset(offsetof(GpuVertex, piece)));
  set_attributes(gl_, 3, sizeof(GpuVertex), {{2, offsetof(GpuVertex, uv)}});
  gl_.EnableVertexAttribArray(4);
  gl_.VertexAttribIPointer(4, 1, GL_UNSIGNED_INT, sizeof(GpuVertex),
                           buffer_offset(offsetof(GpuVertex, paint)));
  gl_.BindBuffer(GL_TEXTURE_BUFFER, slot_buffer_);
  gl_.BindTexture(GL_TEXTURE_BUFFER, slot_texture_);
  gl_.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, slot_buffer_);
}

void Pieces::update(const Frame& frame) {
  SUNDER_CHECK(frame.meshes && frame.materials);
  if (!assign_slots(frame)) {
    // No room: begin again with what this frame shows, which also drops what is gone.
    forget(frame);
    assign_slots(frame);
  }
  upload_new();
  place(frame);
}

/// Gives every instance a slot; false if the buffers are too small for the new ones.
bool Pieces::assign_slots(const Frame& frame) {
  ++frame_number_;
  copies_.resize(std::max(copies_.size(), frame.meshes->size()));
  slot_of_instance_.clear();
  for (const Instance& instance : frame.instances) {
    slot_of_instance_.push_back(
        find_slot(instance.mesh.value, (*frame.meshes)[instance.mesh.value]));
  }
  std::size_t vertices = vertices_;
  std::size_t indices = indices_;
  for (std::size_t s = uploaded_slots_; s < slots_.size(); ++s) {
    vertices += slots_[s].mesh->vertices.size();
    indices += slots_[s].mesh->indices.size();
  }
  return vertices <= vertex_room_ && indices <= index_room_;
}

std::uint32_t Pieces::find_slot(std::uint32_t mesh_index, const std::shared_ptr<const Mesh>& mesh) {
  Copies& copies = copies_[mesh_index];
  // A frame of another run may mean another mesh by the same index.
  if (copies.first != kNone && slots_[copies.first].mesh != mesh) copies = {};
  if (copies.frame != frame_number_) copies = {copies.first, copies.first, frame_number_};
  if (copies.unused != kNone) {
    const std::uint32_t slot = copies.unused;
    copies.unused = slots_[slot].next_copy;
    return slot;
  }
  slots_.push_back({mesh, 0, copies.first, Vec3f::Zero(), 0, false});
  copies.first = static_cast<std::uint32_t>(slots_.size() - 1);
  return copies.first;
}

void Pieces::forget(const Frame& frame) {
  std::size_t vertices = 0;
  std::size_t indices = 0;
  for (const Instance& instance : frame.instances) {
    vertices += (*frame.meshes)[instance.mesh.value]->vertices.size();
    indices += (*frame.meshes)[instance.mesh.value]->indices.size();
  }
  slots_.clear();
  copies_.clear();
  uploaded_slots_ = vertices_ = indices_ = 0;
  vertex_room_ = 2 * vertices + 65536;
  index_room_ = 2 * indices + 131072;
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes(vertex_room_, sizeof(GpuVertex)), nullptr, GL_STATIC_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(index_room_, sizeof(std::uint32_t)), nullptr,
                 GL_STATIC_DRAW);
}

void Pieces::upload_new() {
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t s = uploaded_slots_; s < slots_.size(); ++s) {
    Slot& slot = slots_[s];
    slot.first_index = static_cast<std::uint32_t>(indices_ + indices.size());
    const auto base = static_cast<std::uint32_t>(vertices_ + vertices.size());
    for (const std::uint32_t index : slot.mesh->indices) indices.push_back(base + index);
    Box box;
    for (std::size_t i = 0; i < slot.mesh->vertices.size(); ++i) {
      const Mesh::Vertex& v = slot.mesh->vertices[i];
      const auto piece = static_cast<std::uint32_t>(2 * s) + (v.look == Mesh::kInterior ? 1u : 0u);
      const Eigen::Vector2f uv =
          slot.mesh->uvs.empty() ? Eigen::Vector2f(Eigen::Vector2f::Zero()) : slot.mesh->uvs[i];
      const std::uint32_t paint = v.look >= Mesh::kFirstPaint ? v.look - Mesh::kFirstPaint + 1 : 0;
      slot.painted = slot.painted || paint > 0;
      vertices.push_back({{v.position.x(), v.position.y(), v.position.z()},
                          {v.normal.x(), v.normal.y(), v.normal.z()},
                          piece,
                          {uv.x(), uv.y()},
                          paint});
      box.extend(Vec3(v.position.cast<double>()));
    }
    if (box.empty()) continue;
    slot.center = box.center().cast<float>();
    slot.radius = static_cast<float>(0.5 * box.extent().norm());
  }
  uploaded_slots_ = slots_.size();
  if (indices.empty()) return;
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  gl_.BufferSubData(GL_ARRAY_BUFFER, bytes(vertices_, sizeof(GpuVertex)),
                    bytes(vertices.size(), sizeof(GpuVertex)), vertices.data());
  gl_.BufferSubData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices_, sizeof(std::uint32_t)),
                    bytes(indices.size(), sizeof(std::uint32_t)), indices.data());
  vertices_ += vertices.size();
  indices_ += indices.size();
}

void Pieces::place(const Frame& frame) {
  slot_texels_.resize(std::max<std::size_t>(1, slots_.size()) * kFloatsPerSlot);
  casters_.clear();
  std::array<std::vector<Placed>, kGroups> placed;
  const Vec3 forward = (frame.view.target_W - frame.view.eye_W).normalized();
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    const FrameBody& body = frame.bodies[frame.instances[i].body];
    const std::uint32_t s = slot_of_instance_[i];
    const Slot& slot = slots_[s];
    const Pose& X_RT = slot.mesh->X_RT;
    const Vec3 origin = slot.mesh->origin_T;
    const Mat3f rotation = (body.X_WB.rotation * X_RT.rotation).toRotationMatrix().cast<float>();
    const Vec3f translation =
        (body.X_WB * (X_RT * origin - body.com_R) - frame.view.eye_W).cast<float>();
    float* texels = slot_texels_.data() + s * kFloatsPerSlot;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) texels[4 * row + column] = rotation(row, column);
      texels[4 * row + 3] = translation[row];
      texels[12 + row] = static_cast<float>(origin[row]);
    }
    const MaterialIndex given = frame.instances[i].material;
    const std::uint32_t material = (given.none() ? slot.mesh->material : given).value;
    texels[15] = static_cast<float>(material);

    const Vec3f center = rotation * slot.center + translation;
    const float distance = center.dot(forward.cast<float>());
    const Group group = group_of((*frame.materials)[material]);
    const auto add = [&](Group to) {
      placed[static_cast<std::size_t>(to)].push_back({distance, static_cast<std::uint32_t>(i), s});
    };
    add(slot.painted && given.none() && group != Group::kGlass ? Group::kPainted : group);
    if (group == Group::kMatte && slot.radius > kLarge_m) add(Group::kLarge);
    if (group != Group::kGlass) casters_.push_back({center, slot.radius});
  }
  for (std::size_t g = 0; g < placed.size(); ++g) {
    draws_[g] = ordered(placed[g], static_cast<Group>(g) != Group::kGlass);
  }
  fill_buffer(gl_, GL_TEXTURE_BUFFER, slot_buffer_, slot_texels_, GL_STREAM_DRAW);
}

void Pieces::name_bodies(const Frame& frame) {
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    const std::uint64_t key = frame.bodies[frame.instances[i].body].key;
    slot_texels_[slot_of_instance_[i] * kFloatsPerSlot + 15] = static_cast<float>(key + 1);
  }
  fill_buffer(gl_, GL_TEXTURE_BUFFER, slot_buffer_, slot_texels_, GL_STREAM_DRAW);
}

Pieces::Draws Pieces::ordered(std::vector<Placed>& placed, bool near_first) const {
  std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) {
    if (a.distance != b.distance) return (a.distance < b.distance) == near_first;
    return a.instance < b.instance;
  });
  Draws draws;
  for (const Placed& p : placed) {
    const Slot& slot = slots_[p.slot];
    draws.counts.push_back(static_cast<GLsizei>(slot.mesh->indices.size()));
    draws.offsets.push_back(buffer_offset(slot.first_index * sizeof(std::uint32_t)));
  }
  return draws;
}

void Pieces::draw(Group group) const {
  if (!has(group)) return;
  const Draws& d = draws(group);
  gl_.BindVertexArray(vertex_array_);
  if (group != Group::kGlass) {
    gl_.MultiDrawElements(GL_TRIANGLES, d.counts.data(), GL_UNSIGNED_INT, d.offsets.data(),
                          static_cast<GLsizei>(d.counts.size()));
    return;
  }
  for (std::size_t i = 0; i < d.counts.size(); ++i) {
    for (const GLenum hidden : {GL_FRONT, GL_BACK}) {
      gl_.CullFace(hidden);
      gl_.DrawElements(GL_TRIANGLES, d.counts[i], GL_UNSIGNED_INT, d.offsets[i]);
    }
  }
}

}  // namespace sunder::render
