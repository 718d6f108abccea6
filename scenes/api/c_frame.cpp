// The C interface: what there is to draw.
#include <algorithm>
#include <utility>

#include "scenes/api/c_base.h"

namespace sunder::scenes {
namespace {

void copy_vector(const Vec3f& from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

SunderInstance instance_of(const Frame& frame, const Instance& instance) {
  const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
  const FrameBody& body = frame.bodies[instance.body];
  const Pose X_RM{mesh.X_RT * mesh.origin_T, mesh.X_RT.rotation};
  const Pose X_WM = body.X_WB * Pose{X_RM.position - body.com_R, X_RM.rotation};
  const MaterialIndex material = instance.material.none() ? mesh.material : instance.material;
  return {instance.mesh.value,
          {static_cast<std::uint32_t>(body.key)},
          material_of(material),
          pose(X_WM)};
}

FrameArrays frame_arrays(FramePtr frame) {
  FrameArrays arrays;
  for (const Instance& instance : frame->instances)
    arrays.instances.push_back(instance_of(*frame, instance));
  for (const FrameDebris& chip : frame->debris) {
    SunderDebris debris{};
    copy_vector(chip.position_W, debris.position_W);
    for (int i = 0; i < 4; ++i) debris.rotation[i] = chip.rotation_WD.coeffs()[i];
    debris.radius_m = chip.radius_m;
    debris.material = material_of(chip.material);
    arrays.debris.push_back(debris);
  }
  for (const FrameDust& puff : frame->dust) {
    SunderDust dust{};
    copy_vector(puff.position_W, dust.position_W);
    dust.radius_m = puff.radius_m;
    dust.opacity = puff.opacity;
    dust.material = material_of(puff.material);
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
      entry.frame = frame_arrays(std::move(present));
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
              arrays.frame->meshes ? count_of(arrays.frame->meshes->size()) : 0};
  });
}

SunderResult sunder_world_mesh(SunderWorld world, uint32_t mesh, SunderMesh* out) {
  return ask_world("sunder_world_mesh", world, [&](WorldEntry& entry) {
    need_pointer(out, "out");
    if (!entry.frame) refuse("there is no frame; call sunder_world_frame() before");
    FrameArrays& arrays = *entry.frame;
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
    *out = {data_of(vertices->second), count_of(vertices->second.size()),
            found->indices.empty() ? nullptr : found->indices.data(),
            count_of(found->indices.size()), material_of(found->material)};
  });
}
