// The C interface: what there is to draw.
#include <algorithm>
#include <utility>

#include "scenes/api/c_base.h"

namespace sunder::scenes {
namespace {

void copy_vector(const Vec3f& from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

SunderInstance instance_of(WorldEntry& entry, const Frame& frame, const Instance& instance) {
  const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
  const FrameBody& body = frame.bodies[instance.body];
  const Pose X_RM{mesh.X_RT * mesh.origin_T, mesh.X_RT.rotation};
  const Pose X_WM = body.X_WB * Pose{X_RM.position - body.com_R, X_RM.rotation};
  const MaterialIndex material = instance.material.none() ? mesh.material : instance.material;
  return {instance.mesh.value,
          {static_cast<std::uint32_t>(body.key)},
          material_of(entry, material),
          pose(X_WM)};
}

FrameArrays frame_arrays(WorldEntry& entry, FramePtr frame) {
  FrameArrays arrays;
  for (const Instance& instance : frame->instances)
    arrays.instances.push_back(instance_of(entry, *frame, instance));
  for (const FrameDebris& chip : frame->debris) {
    SunderDebris debris{};
    copy_vector(chip.position_W, debris.position_W);
    for (int i = 0; i < 4; ++i) debris.rotation[i] = chip.rotation_WD.coeffs()[i];
    debris.radius_m = chip.radius_m;
    debris.material = material_of(entry, chip.material);
    arrays.debris.push_back(debris);
  }
  for (const FrameDust& puff : frame->dust) {
    SunderDust dust{};
    copy_vector(puff.position_W, dust.position_W);
    dust.radius_m = puff.radius_m;
    dust.opacity = puff.opacity;
    dust.material = material_of(entry, puff.material);
    arrays.dust.push_back(dust);
  }
  arrays.frame = std::move(frame);
  return arrays;
}

Array<SunderVertex> vertices_of(const Mesh& mesh) {
  Array<SunderVertex> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Mesh::Vertex& from : mesh.vertices) {
    SunderVertex vertex{};
    copy_vector(from.position, vertex.position);
    copy_vector(from.normal, vertex.normal);
    vertex.look = from.look;
    vertices.push_back(vertex);
  }
  return vertices;
}

SunderImage image_of(const EncodedImage& image) {
  if (!image) return {nullptr, 0};
  return {image->data(), image->size()};
}

/// Returns the frame that was taken last.
FrameArrays& last_frame(WorldEntry& entry) {
  if (!entry.frame) refuse("there is no frame; call sunder_world_frame() before");
  return *entry.frame;
}

std::size_t appearance_count(const Frame& frame) {
  return frame.appearances ? frame.appearances->size() : 0;
}

static_assert(sizeof(Eigen::Vector2f) == 2 * sizeof(float));
static_assert(Mesh::kSurface == SUNDER_LOOK_SURFACE && Mesh::kInterior == SUNDER_LOOK_INTERIOR &&
              Mesh::kFirstAppearance == SUNDER_LOOK_FILE && kGroundKey == SUNDER_NO_KEY);

}  // namespace
}  // namespace sunder::scenes

using namespace sunder;
using namespace sunder::scenes;

SunderResult sunder_world_frame(SunderWorld world, SunderFrame* frame) {
  return ask_world("sunder_world_frame", world, [&](WorldEntry& entry) {
    need_pointer(frame, "frame");
    FramePtr present = entry.world.frame();
    if (!entry.frame || entry.frame->frame != present) {
      entry.frame.reset();
      entry.frame = frame_arrays(entry, std::move(present));
    }
    const FrameArrays& arrays = *entry.frame;
    *frame = {arrays.frame->index,
              arrays.frame->time_s,
              data_of(arrays.instances),
              count_of(arrays.instances.size()),
              data_of(arrays.debris),
              count_of(arrays.debris.size()),
              data_of(arrays.dust),
              count_of(arrays.dust.size()),
              arrays.frame->meshes ? count_of(arrays.frame->meshes->size()) : 0,
              count_of(appearance_count(*arrays.frame))};
  });
}

SunderResult sunder_world_mesh(SunderWorld world, uint32_t mesh, SunderMesh* out) {
  return ask_world("sunder_world_mesh", world, [&](WorldEntry& entry) {
    need_pointer(out, "out");
    FrameArrays& arrays = last_frame(entry);
    const std::size_t count = arrays.frame->meshes ? arrays.frame->meshes->size() : 0;
    if (mesh >= count)
      refuse("mesh is " + std::to_string(mesh) + "; expected an index below " +
             std::to_string(count));
    const Mesh* found = (*arrays.frame->meshes)[mesh].get();
    if (!found)
      refuse("mesh is " + std::to_string(mesh) + ", with which nothing is drawn any more");
    auto vertices = arrays.vertices.find(mesh);
    if (vertices == arrays.vertices.end())
      vertices = arrays.vertices.emplace(mesh, vertices_of(*found)).first;
    *out = {data_of(vertices->second),
            count_of(vertices->second.size()),
            found->indices.empty() ? nullptr : found->indices.data(),
            count_of(found->indices.size()),
            material_of(entry, found->material),
            found->uvs.empty() ? nullptr : found->uvs.front().data()};
  });
}

SunderResult sunder_world_appearance(SunderWorld world, uint32_t index,
                                     SunderAppearance* appearance) {
  return ask_world("sunder_world_appearance", world, [&](WorldEntry& entry) {
    need_pointer(appearance, "appearance");
    const Frame& frame = *last_frame(entry).frame;
    if (const std::size_t count = appearance_count(frame); index >= count)
      refuse("index is " + std::to_string(index) + "; expected an index below " +
             std::to_string(count));
    const Appearance& from = (*frame.appearances)[index];
    SunderAppearance found{};
    copy_vector(from.color, found.color);
    found.picture = image_of(from.picture);
    found.v_from_bottom = from.v_from_bottom;
    found.relief = image_of(from.relief);
    found.normal_scale = from.normal_scale;
    found.has_gloss = from.gloss.has_value();
    const MetallicRoughness gloss = from.gloss.value_or(MetallicRoughness{});
    found.roughness = gloss.roughness;
    found.metallic = gloss.metallic;
    found.gloss = image_of(from.gloss ? from.gloss->picture : nullptr);
    *appearance = found;
  });
}
