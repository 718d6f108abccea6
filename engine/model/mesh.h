// Triangles to draw, and the store they are kept in.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/index.h"
#include "engine/base/types.h"
#include "engine/model/material.h"

namespace sunder {

/// What is drawn of one convex (or ball): immutable. Positions are floats around `origin_R`, so
/// precision does not depend on where in the solid the piece was; rest-space textures use
/// origin_R + position.
struct Mesh {
  struct Vertex {
    Vec3f position = Vec3f::Zero();
    Vec3f normal = Vec3f::UnitY();
    std::uint32_t interior = 0;  ///< 1 where a break made the face.
  };
  Vec3 origin_R = Vec3::Zero();
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< Triangles, counter-clockwise seen from outside.
  MaterialIndex material;
};

struct MeshTag;
using MeshIndex = Index<MeshTag>;
/// Append-only: an index never changes its meaning. A frame keeps the store of its instant.
using MeshStore = std::vector<std::shared_ptr<const Mesh>>;

}  // namespace sunder
