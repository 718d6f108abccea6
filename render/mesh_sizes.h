// Approximate sizes of meshes, which frames do not contain.
#pragma once

#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

/// Sizes of the meshes of a run, each computed once.
class MeshSizes {
 public:
  /// Returns the diagonal of the bounding box of a mesh, in m; 0 without vertices.
  double diagonal_m(const Frame& frame, MeshIndex mesh) {
    const MeshStore& meshes = *frame.meshes;
    while (known_m_.size() < meshes.size()) {
      Box box;
      for (const Mesh::Vertex& vertex : meshes[known_m_.size()]->vertices)
        box.extend(Vec3(vertex.position.cast<double>()));
      known_m_.push_back(box.empty() ? 0 : box.extent().norm());
    }
    return known_m_[mesh.value];
  }

 private:
  std::vector<double> known_m_;
};

}  // namespace sunder::render
