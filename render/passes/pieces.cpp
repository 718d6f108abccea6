#include "render/passes/pieces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "engine/base/check.h"
#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "render/gl/objects.h"

namespace sunder::render {
namespace {

constexpr std::size_t kFloatsPerSlot = 24;
constexpr float kLargeRadius_m = 0.25f;   // least radius of a piece of Group::kLarge
constexpr float kHeightDetail_m = 0.06f;  // size of the cubes in which vertices are merged
// Least number of pieces for a round of occlusion culling.
constexpr std::size_t kMinPiecesToCull = 2000;
constexpr int kMaxCullingRounds = 3;  // greatest number of rounds of occlusion culling

struct GpuVertex {
  float position[3];
  float normal[3];
  std::uint32_t piece;  ///< Slot * 2 + 1 if interior.
  float uv[2];
  std::uint32_t appearance;  ///< Number of the appearance, from 1, or 0 for none.
};

using Key = std::array<std::int32_t, 3>;

/// Returns for each vertex the index of the first vertex with the same key.
template <class KeyOf>
std::vector<std::uint32_t> first_with_same_key(const Mesh& mesh, const KeyOf& key_of) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<Key> keys;
  for (const Mesh::Vertex& vertex : mesh.vertices) keys.push_back(key_of(vertex.position));
  std::vector<std::uint32_t> first(keys.size());
  std::vector<std::uint32_t> table(std::bit_ceil(2 * keys.size() + 1), kNone);
  for (std::uint32_t v = 0; v < keys.size(); ++v) {
    std::uint64_t hash = 0;
    for (const std::int32_t part : keys[v]) hash = combine(hash, static_cast<std::uint32_t>(part));
    std::size_t at = hash & (table.size() - 1);
    while (table[at] != kNone && keys[table[at]] != keys[v]) at = (at + 1) & (table.size() - 1);
    if (table[at] == kNone) table[at] = v;
    first[v] = table[at];
  }
  return first;
}

/// Returns the triangles with each vertex replaced by first[vertex], without those of no area.
std::vector<std::uint32_t> merge_vertices(const Mesh& mesh,
                                          const std::vector<std::uint32_t>& first) {
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t a = first[mesh.indices[i]];
    const std::uint32_t b = first[mesh.indices[i + 1]];
    const std::uint32_t c = first[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
  }
  return indices;
}

/// Returns the triangles for depth passes: vertices at the same position are merged.
std::vector<std::uint32_t> indices_for_depths(const Mesh& mesh) {
  return merge_vertices(mesh, first_with_same_key(mesh, [](const Vec3f& place) {
                          return Key{std::bit_cast<std::int32_t>(place.x()),
                                     std::bit_cast<std::int32_t>(place.y()),
                                     std::bit_cast<std::int32_t>(place.z())};
                        }));
}

/// Returns the triangles for heights: vertices in small cubes, finer than the sky light, are
/// merged.
std::vector<std::uint32_t> indices_for_heights(const Mesh& mesh) {
  return merge_vertices(mesh, first_with_same_key(mesh, [](const Vec3f& place) {
                          const auto cube = [](float x) {
                            return static_cast<std::int32_t>(std::floor(x / kHeightDetail_m));
                          };
                          return Key{cube(place.x()), cube(place.y()), cube(place.z())};
                        }));
}

/// Flags likely occluders: in each part of the image the nearest, and those behind by half their
/// size.
std::vector<std::uint8_t> find_likely_occluders(const std::vector<std::uint32_t>& instances,
                                                const std::vector<OrientedBox>& boxes,
                                                const CullingView& view) {
  constexpr std::size_t kParts = 64;  // parts along each side of the image
  std::vector<float> nearest(kParts * kParts, 1e30f);
  std::vector<std::size_t> part_of;
  part_of.reserve(instances.size());
  for (const std::uint32_t i : instances) {
    const Eigen::Vector4f at = view.picture_of_eye * boxes[i].center.homogeneous();
    const auto part = [&](float x) {
      return static_cast<std::size_t>(std::clamp(x / at.w() * kParts, 0.f, kParts - 1.f));
    };
    part_of.push_back(part(at.y()) * kParts + part(at.x()));
    float& least = nearest[part_of.back()];
    least = std::min(least, view.ahead.dot(boxes[i].center));
  }
  std::vector<std::uint8_t> front(instances.size());
  for (std::size_t k = 0; k < instances.size(); ++k) {
    const OrientedBox& box = boxes[instances[k]];
    front[k] = view.ahead.dot(box.center) <= nearest[part_of[k]] + box.half_axes.norm();
  }
  return front;
}

GLsizeiptr bytes(std::size_t count, std::size_t size) {
  return static_cast<GLsizeiptr>(count * size);
}

Pieces::Group group_of(const Material& material, bool is_alone) {
  switch (material.surface.texture) {
    case Texture::kGlass:
      return Pieces::Group::kGlass;
    case Texture::kMetal:
      return Pieces::Group::kShiny;
    case Texture::kPlaster:
      return is_alone ? Pieces::Group::kBlocks : Pieces::Group::kMatte;
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
                           buffer_offset(offsetof(GpuVertex, appearance)));
  gl_.BindBuffer(GL_TEXTURE_BUFFER, slot_buffer_);
  gl_.BindTexture(GL_TEXTURE_BUFFER, slot_texture_);
  gl_.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, slot_buffer_);
}

void Pieces::update(const Frame& frame) {
  SUNDER_CHECK(frame.meshes && frame.materials);
  assign_slots(frame);
  if (!upload_new()) {
    // The buffers are full: start again with the meshes of this frame, which drops unused ones.
    clear_uploads();
    assign_slots(frame);
    upload_new();
  }
  update_transforms(frame);
}

/// Assigns a slot to every instance.
void Pieces::assign_slots(const Frame& frame) {
  ++frame_number_;
  copies_.resize(std::max(copies_.size(), frame.meshes->size()));
  slot_of_instance_.clear();
  for (const Instance& instance : frame.instances) {
    slot_of_instance_.push_back(
        find_slot(instance.mesh.value, (*frame.meshes)[instance.mesh.value]));
  }
}

std::uint32_t Pieces::find_slot(std::uint32_t mesh_index, const std::shared_ptr<const Mesh>& mesh) {
  Copies& copies = copies_[mesh_index];
  // In a frame of another run, the index may belong to another mesh.
  if (copies.first != kNone && slots_[copies.first].mesh != mesh) copies = {};
  if (copies.frame != frame_number_) copies = {copies.first, copies.first, frame_number_};
  if (copies.unused != kNone) {
    const std::uint32_t slot = copies.unused;
    copies.unused = slots_[slot].next_copy;
    return slot;
  }
  slots_.push_back({mesh, copies.first});
  copies.first = static_cast<std::uint32_t>(slots_.size() - 1);
  return copies.first;
}

void Pieces::clear_uploads() {
  slots_.clear();
  copies_.clear();
  uploaded_slots_ = vertices_ = indices_ = 0;
}

/// Uploads new slots. Returns false if the buffers are too small and not empty; empty ones grow.
bool Pieces::upload_new() {
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t s = uploaded_slots_; s < slots_.size(); ++s) {
    Slot& slot = slots_[s];
    const auto base = static_cast<std::uint32_t>(vertices_ + vertices.size());
    const auto added = [&](const std::vector<std::uint32_t>& corners) {
      const Range range = {static_cast<std::uint32_t>(indices_ + indices.size()),
                           static_cast<std::uint32_t>(corners.size())};
      for (const std::uint32_t corner : corners) indices.push_back(base + corner);
      return range;
    };
    const std::vector<std::uint32_t> depths = indices_for_depths(*slot.mesh);
    const std::vector<std::uint32_t> heights = indices_for_heights(*slot.mesh);
    auto& [lit, cast, high] = slot.indices;
    lit = added(slot.mesh->indices);
    cast = depths == slot.mesh->indices ? lit : added(depths);
    high = 2 * heights.size() > depths.size() ? cast : added(heights);
    Box box;
    for (std::size_t i = 0; i < slot.mesh->vertices.size(); ++i) {
      const Mesh::Vertex& v = slot.mesh->vertices[i];
      const auto piece = static_cast<std::uint32_t>(2 * s) + (v.look == Mesh::kInterior ? 1u : 0u);
      const Eigen::Vector2f uv =
          slot.mesh->uvs.empty() ? Eigen::Vector2f(Eigen::Vector2f::Zero()) : slot.mesh->uvs[i];
      const std::uint32_t appearance =
          v.look >= Mesh::kFirstAppearance ? v.look - Mesh::kFirstAppearance + 1 : 0;
      slot.textured = slot.textured || appearance > 0;
      vertices.push_back({{v.position.x(), v.position.y(), v.position.z()},
                          {v.normal.x(), v.normal.y(), v.normal.z()},
                          piece,
                          {uv.x(), uv.y()},
                          appearance});
      box.extend(Vec3(v.position.cast<double>()));
    }
    if (box.empty()) continue;
    slot.center = box.center().cast<float>();
    slot.half_extent = (0.5 * box.extent()).cast<float>();
    slot.sides = sides_of(*slot.mesh, box);
  }
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
  if (vertices_ + vertices.size() > vertex_capacity_ ||
      indices_ + indices.size() > index_capacity_) {
    if (uploaded_slots_ > 0) return false;
    vertex_capacity_ = 2 * vertices.size() + 65536;
    index_capacity_ = 2 * indices.size() + 131072;
    gl_.BufferData(GL_ARRAY_BUFFER, bytes(vertex_capacity_, sizeof(GpuVertex)), nullptr,
                   GL_STATIC_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(index_capacity_, sizeof(std::uint32_t)), nullptr,
                   GL_STATIC_DRAW);
  }
  uploaded_slots_ = slots_.size();
  if (indices.empty()) return true;
  gl_.BufferSubData(GL_ARRAY_BUFFER, bytes(vertices_, sizeof(GpuVertex)),
                    bytes(vertices.size(), sizeof(GpuVertex)), vertices.data());
  gl_.BufferSubData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices_, sizeof(std::uint32_t)),
                    bytes(indices.size(), sizeof(std::uint32_t)), indices.data());
  vertices_ += vertices.size();
  indices_ += indices.size();
  return true;
}

void Pieces::update_transforms(const Frame& frame) {
  slot_texels_.resize(std::max<std::size_t>(1, slots_.size()) * kFloatsPerSlot);
  casters_.clear();
  boxes_.clear();
  std::array<std::vector<Placed>, kGroups> placed;
  const Vec3 forward = (frame.view.target_W - frame.view.eye_W).normalized();
  std::vector<std::uint32_t> parts(frame.bodies.size());
  for (const Instance& instance : frame.instances) ++parts[instance.body];
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
    const BlockTone tone = tone_of(body.key);
    for (int axis = 0; axis < 3; ++axis) {
      texels[16 + axis] = static_cast<float>(origin[axis]) + slot.sides.low[axis];
      texels[20 + axis] = static_cast<float>(origin[axis]) + slot.sides.high[axis];
    }
    texels[19] = tone.brightness;
    texels[23] = tone.redness;

    const Vec3f center = rotation * slot.center + translation;
    boxes_.push_back({center, rotation * slot.half_extent.asDiagonal()});
    const float radius = slot.half_extent.norm();
    const float distance = center.dot(forward.cast<float>());
    const bool is_alone = parts[frame.instances[i].body] == 1 && given.none();
    const Group group = group_of((*frame.materials)[material], is_alone);
    const auto add = [&](Group to) {
      placed[static_cast<std::size_t>(to)].push_back({distance, static_cast<std::uint32_t>(i)});
    };
    add(slot.textured && given.none() && group != Group::kGlass ? Group::kTextured : group);
    if ((group == Group::kMatte || group == Group::kBlocks) && radius > kLargeRadius_m)
      add(Group::kLarge);
    if (group == Group::kGlass) continue;
    add(Group::kOpaque);
    casters_.push_back({center, radius});
  }
  for (std::size_t g = 0; g < placed.size(); ++g) {
    const bool near_first = static_cast<Group>(g) != Group::kGlass;
    if (static_cast<Group>(g) < Group::kOpaque) {
      std::sort(placed[g].begin(), placed[g].end(), [&](const Placed& a, const Placed& b) {
        if (a.distance != b.distance) return (a.distance < b.distance) == near_first;
        return a.instance < b.instance;
      });
    }
    placed_[g].clear();
    for (const Placed& p : placed[g]) placed_[g].push_back(p.instance);
  }
  fill_buffer(gl_, GL_TEXTURE_BUFFER, slot_buffer_, slot_texels_, GL_STREAM_DRAW);
}

void Pieces::write_body_ids(const Frame& frame) {
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    const std::uint64_t key = frame.bodies[frame.instances[i].body].key;
    slot_texels_[slot_of_instance_[i] * kFloatsPerSlot + 15] = static_cast<float>(key + 1);
  }
  fill_buffer(gl_, GL_TEXTURE_BUFFER, slot_buffer_, slot_texels_, GL_STREAM_DRAW);
}

void Pieces::draw(Group group) const {
  if (group != Group::kGlass) return draw(placed(group), Faces::kLit);
  gl_.BindVertexArray(vertex_array_);
  for (const std::uint32_t instance : placed(group)) {
    const Range lit = slots_[slot_of_instance_[instance]].indices.front();
    for (const GLenum hidden : {GL_FRONT, GL_BACK}) {
      gl_.CullFace(hidden);
      gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(lit.count), GL_UNSIGNED_INT,
                       buffer_offset(lit.first * sizeof(std::uint32_t)));
    }
  }
}

void Pieces::draw(Group group, DepthTiles& depth_tiles) const {
  draw_unoccluded(group, Faces::kLit, depth_tiles);
}

void Pieces::draw_shadows(DepthTiles& depth_tiles) const {
  draw_unoccluded(Group::kOpaque, Faces::kDepths, depth_tiles);
}

void Pieces::draw_heights(DepthTiles& depth_tiles) const {
  draw_unoccluded(Group::kLarge, Faces::kHeights, depth_tiles);
}

void Pieces::draw_unoccluded(Group group, Faces faces, DepthTiles& depth_tiles) const {
  std::vector<std::uint32_t> left = placed(group);
  remove_occluded(left, depth_tiles);
  for (int round = 0; round < kMaxCullingRounds && left.size() >= kMinPiecesToCull; ++round) {
    const std::vector<std::uint8_t> front = find_likely_occluders(left, boxes_, depth_tiles.view());
    std::vector<std::uint32_t> first, rest;
    for (std::size_t k = 0; k < left.size(); ++k) {
      (front[k] != 0 ? first : rest).push_back(left[k]);
    }
    draw(first, faces);
    depth_tiles.read();
    left = std::move(rest);
    remove_occluded(left, depth_tiles);
  }
  draw(left, faces);
}

void Pieces::remove_occluded(std::vector<std::uint32_t>& instances,
                             const DepthTiles& depth_tiles) const {
  std::vector<std::uint8_t> hidden(instances.size());
  for_chunks(hidden.size(), 512, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) hidden[k] = depth_tiles.hides(boxes_[instances[k]]);
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    if (hidden[k] == 0) instances[kept++] = instances[k];
  }
  instances.resize(kept);
}

void Pieces::draw(const std::vector<std::uint32_t>& instances, Faces faces) const {
  if (instances.empty()) return;
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  for (const std::uint32_t instance : instances) {
    const Slot& slot = slots_[slot_of_instance_[instance]];
    const Range range = slot.indices[static_cast<std::size_t>(faces)];
    counts.push_back(static_cast<GLsizei>(range.count));
    offsets.push_back(buffer_offset(range.first * sizeof(std::uint32_t)));
  }
  gl_.BindVertexArray(vertex_array_);
  gl_.MultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                        static_cast<GLsizei>(counts.size()));
}

}  // namespace sunder::render
