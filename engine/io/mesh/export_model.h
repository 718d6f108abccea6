// Solids on their way to other programs: closed surfaces with materials, part by part.
//
// Read first: make_model(); engine/io/mesh/glb_writer.h and engine/io/mesh/obj_writer.h write it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/model/compound.h"

namespace sunder {

struct Model {
  struct Material {
    std::string name;
    Paint look;
  };
  /// A watertight surface, and what its faces are made of.
  struct Shell {
    std::shared_ptr<const PolygonMesh> mesh;
    std::vector<std::uint32_t> materials;  ///< By face.
  };
  /// What moves as one.
  struct Part {
    std::string name;
    Vec3 center = Vec3::Zero();  ///< Of its bounding box, where its shells are.
    Vec3 offset = Vec3::Zero();  ///< How far it is moved from there.
    std::vector<Shell> shells;
  };
  std::vector<Material> materials;
  std::vector<Part> parts;
  std::size_t walled_parts = 0;  ///< Parts whose walls could not be removed, and were kept.
};

/// Says if an export keeps the faces between convexes of one piece.
enum class Walls : std::uint8_t { kRemove, kKeep };

/// Makes a part of each compound. A part has one shell, its outer surface, walls included where
/// they cannot be removed; or, where walls are kept, one shell for each convex: its visual mesh, or
/// itself if it has none.
/// Parts are moved away from the middle of all by `explode` times their distance from it. Faces are
/// marked by `paints`, which are materials of their own.
Model make_model(std::span<const Compound> pieces, std::span<const Material> materials,
                 double explode, std::span<const Paint> paints = {}, Walls walls = Walls::kRemove);

/// A shell as triangles to draw.
struct ShellTriangles {
  struct Vertex {
    std::uint32_t point = 0;  ///< Of the mesh's vertices.
    Vec3f normal = Vec3f::Zero();
    Vec2f uv = Vec2f::Zero();  ///< In metres of the rest frame where the mesh has none.
  };
  std::vector<Vertex> vertices;                               ///< Each once.
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces;  ///< By material.
};
ShellTriangles triangles_of(const Model::Shell& shell);

}  // namespace sunder
