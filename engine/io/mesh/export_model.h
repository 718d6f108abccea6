// Export of solids to other programs: closed surfaces with materials, in parts.
//
// Begin with make_model(); glb_writer.h and obj_writer.h beside it write the model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/polygon_mesh.h"
#include "engine/geometry/walls/outer_surface.h"
#include "engine/model/compound.h"

namespace sunder {

/// A model to export.
struct Model {
  struct Material {
    std::string name;
    Appearance look;
  };
  /// A watertight surface and the materials of its faces.
  struct Shell {
    std::shared_ptr<const PolygonMesh> mesh;
    std::vector<std::uint32_t> materials;  ///< Index into Model::materials of each face.
  };
  /// A piece, which moves as one body.
  struct Part {
    std::string name;
    Vec3 center = Vec3::Zero();  ///< Centre of the bounding box of its shells.
    Vec3 offset = Vec3::Zero();  ///< Displacement of the part from its original position.
    std::vector<Shell> shells;
  };
  std::vector<Material> materials;
  std::vector<Part> parts;
  std::size_t parts_with_walls = 0;  ///< Number of parts whose inner walls could not be removed.
};

/// Selects if an export keeps the faces between convexes of one piece.
enum class Walls : std::uint8_t { kRemove, kKeep };

/// Returns the surface of a piece as it is exported with Walls::kRemove; `from` of a face is the
/// index of its convex. Sets `has_walls` to true if inner walls could not be removed.
OuterSurface exported_surface(const Compound& piece, bool& has_walls);

/// Makes a part of each compound. With Walls::kRemove, a part has one shell, its outer surface;
/// inner walls that cannot be removed remain. With Walls::kKeep, a part has one shell for each
/// convex: its visual mesh, or its polyhedron if it has none. Parts are displaced from the centre
/// of the model by `explode` times their distance from it. `appearances` are those of
/// faces (PolygonMesh::Face::appearance), and become materials of their own.
Model make_model(std::span<const Compound> pieces, std::span<const Material> materials,
                 double explode, std::span<const Appearance> appearances = {},
                 Walls walls = Walls::kRemove);

/// Triangles of a shell, with one vertex per combination of point, normal and texture coordinate.
struct ShellTriangles {
  struct Vertex {
    std::uint32_t point = 0;  ///< Index of a vertex of the shell's mesh.
    Vec3f normal = Vec3f::Zero();
    /// Without texture coordinates in the mesh: metres in the rest frame, projected on the face.
    Vec2f uv = Vec2f::Zero();
  };
  std::vector<Vertex> vertices;  ///< Unique.
  /// Vertex indices of triangles, by material.
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces;
};
/// Triangulates a shell.
ShellTriangles triangles_of(const Model::Shell& shell);

}  // namespace sunder
