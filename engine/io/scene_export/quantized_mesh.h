// Meshes in 16-bit coordinates, as KHR_mesh_quantization of glTF has them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/frame.h"

namespace sunder {

/// A mesh whose positions are fractions of a cube around it: position = center_T + half_m *
/// fraction, within half_m / 65534 along each axis. Normals are within half a degree.
struct QuantizedMesh {
  /// A vertex as it is in the file.
  struct Vertex {
    std::array<std::int16_t, 3> position = {};  ///< Fractions times 32767.
    std::int16_t no_position = 0;
    std::array<std::int8_t, 3> normal = {};  ///< Components times 127.
    std::int8_t no_normal = 0;
  };
  /// Triangles of one appearance (Mesh::Vertex::look).
  struct Part {
    std::uint32_t look = 0;
    std::vector<std::uint32_t> indices;
  };
  Vec3 center_T = Vec3::Zero();  ///< With the mesh's origin_T added.
  double half_m = 1;
  std::array<std::int16_t, 3> low = {}, high = {};  ///< Bounds of the positions.
  std::vector<Vertex> vertices;
  std::vector<Eigen::Vector2f> uvs;  ///< v = 0 is the top row of an image; empty if there are none.
  std::vector<Part> parts;           ///< Ascending by look.
};

/// Quantises a mesh with at least one triangle. `appearances`: those of the frame.
QuantizedMesh quantize(const Mesh& mesh, std::span<const Appearance> appearances);

}  // namespace sunder
