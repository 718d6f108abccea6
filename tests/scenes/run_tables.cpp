#include "tests/scenes/run_tables.h"

#include <algorithm>
#include <fstream>

namespace sunder::tests {
namespace {

void write_table(const std::filesystem::path& file, const std::vector<double>& numbers) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::streamsize>(sizeof(double) * numbers.size()));
}

}  // namespace

void RunTables::take(const FramePtr& frame) {
  const auto index = static_cast<double>(frame->index);
  for (const FrameBody& body : frame->bodies) {
    ++bodies_[body.key];
    const Vec3& p = body.X_WB.position;
    const Quat& q = body.X_WB.rotation;
    poses_.insert(poses_.end(),
                  {index, static_cast<double>(body.key), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                   q.w(), body.com_R.x(), body.com_R.y(), body.com_R.z()});
  }
  if (std::ranges::find(box_frames_, frame->index) == box_frames_.end()) return;
  Box debris;
  for (const FrameDebris& chip : frame->debris) debris.extend(chip.position_W.cast<double>());
  chips_.insert(chips_.end(),
                {index, static_cast<double>(frame->debris.size()), debris.min.x(), debris.min.y(),
                 debris.min.z(), debris.max.x(), debris.max.y(), debris.max.z()});
  std::vector<Box> boxes(frame->bodies.size());
  std::vector<std::size_t> vertices(frame->bodies.size());
  for (const Instance& instance : frame->instances) {
    const FrameBody& body = frame->bodies[instance.body];
    const Mesh& mesh = *(*frame->meshes)[instance.mesh.value];
    for (const Mesh::Vertex& vertex : mesh.vertices) {
      const Vec3 point_T = mesh.origin_T + vertex.position.cast<double>();
      boxes[instance.body].extend(body.X_WB * (mesh.X_RT * point_T - body.com_R));
    }
    vertices[instance.body] += mesh.vertices.size();
  }
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const Vec3 &low = boxes[b].min, &high = boxes[b].max;
    boxes_.insert(boxes_.end(), {index, static_cast<double>(frame->bodies[b].key),
                                 static_cast<double>(vertices[b]), low.x(), low.y(), low.z(),
                                 high.x(), high.y(), high.z()});
  }
}

void RunTables::write(const std::filesystem::path& poses, const std::filesystem::path& boxes,
                      const std::filesystem::path& chips) const {
  write_table(poses, poses_);
  write_table(boxes, boxes_);
  write_table(chips, chips_);
}

}  // namespace sunder::tests
