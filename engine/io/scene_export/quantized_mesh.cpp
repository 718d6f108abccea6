#include "engine/io/scene_export/quantized_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sunder {
namespace {

constexpr double kLeastHalf_m = 1e-9;  // of a mesh that is a point
constexpr double kPositionFractions = 32767, kNormalFractions = 127;

std::int8_t normal_code(float component) {
  const double clamped = std::clamp(static_cast<double>(component), -1.0, 1.0);
  return static_cast<std::int8_t>(std::rint(clamped * kNormalFractions));
}

std::array<std::int8_t, 3> normal_codes(const Vec3f& normal) {
  if (!(std::abs(normal.squaredNorm() - 1) < 1e-2f)) return {0, 127, 0};
  return {normal_code(normal.x()), normal_code(normal.y()), normal_code(normal.z())};
}

void add_vertices(const Mesh& mesh, const Vec3& center, QuantizedMesh& to) {
  to.vertices.reserve(mesh.vertices.size());
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    QuantizedMesh::Vertex& made = to.vertices.emplace_back();
    made.normal = normal_codes(vertex.normal);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double fraction =
          (static_cast<double>(vertex.position[axis]) - center[axis]) / to.half_m;
      made.position[i] = static_cast<std::int16_t>(
          std::rint(std::clamp(fraction, -1.0, 1.0) * kPositionFractions));
    }
  }
  to.low = to.high = to.vertices.front().position;
  for (const QuantizedMesh::Vertex& vertex : to.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      to.low[i] = std::min(to.low[i], vertex.position[i]);
      to.high[i] = std::max(to.high[i], vertex.position[i]);
    }
  }
}

void add_uvs(const Mesh& mesh, std::span<const Appearance> appearances, QuantizedMesh& to) {
  to.uvs = mesh.uvs;
  for (std::size_t v = 0; v < to.uvs.size(); ++v) {
    const std::uint32_t look = mesh.vertices[v].look;
    if (look < Mesh::kFirstAppearance) continue;
    if (appearances[look - Mesh::kFirstAppearance].v_from_bottom) to.uvs[v].y() = 1 - to.uvs[v].y();
  }
}

}  // namespace

QuantizedMesh quantize(const Mesh& mesh, std::span<const Appearance> appearances) {
  QuantizedMesh to;
  Box box;
  for (const Mesh::Vertex& vertex : mesh.vertices) box.extend(vertex.position.cast<double>());
  to.half_m = std::max(kLeastHalf_m, 0.5 * box.extent().maxCoeff());
  to.center_T = mesh.origin_T + box.center();
  add_vertices(mesh, box.center(), to);
  add_uvs(mesh, appearances, to);
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_look;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    auto& indices = by_look[mesh.vertices[mesh.indices[i]].look];
    indices.insert(indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  }
  for (auto& [look, indices] : by_look) to.parts.push_back({look, std::move(indices)});
  return to;
}

}  // namespace sunder
