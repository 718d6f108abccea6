// Makes the compound of a MESH on the command line, or of `mesh = "..."` in a scene: reads, repairs
// and decomposes files and built-in meshes, and makes built-in solids of convexes.
//
// Read first: make_mesh_solid().
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/raw_mesh.h"
#include "engine/geometry/repair/repair.h"
#include "fracture/vacd/vacd.h"
#include "scenes/file/make_compound.h"

namespace sunder::scenes {

/// A compound, and figures of the mesh that it was made from. The materials are indices: 0 is the
/// default one, i + 1 is that of MeshOptions::materials[i]. Appearances of faces are those of the
/// list MeshOptions::appearances.
struct MeshSolid {
  Compound compound;
  /// Origin of the compound in the coordinates of the mesh, in m: 0 unless the mesh is far from its
  /// origin, where doubles are too coarse.
  Vec3 origin = Vec3::Zero();
  std::string name;
  std::size_t vertices = 0;  ///< Vertices of the mesh before repairs.
  std::size_t faces = 0;     ///< Polygons of the mesh before repairs.
  bool closed = true;        ///< True if the mesh was closed before repairs.
  std::vector<Repair> repairs;
  std::optional<fracture::VacdFigures> vacd;  ///< None for a compound that was not decomposed.
  /// Missing texture and material files; a coarse decomposition.
  std::vector<std::string> warnings;
  double prepare_ms = 0;  ///< Time of reading, repairs and decomposition.
};

/// Throws InputError unless the scale of a built-in solid is 1.
void need_no_scale(const std::string& mesh, double scale);
/// Makes the compound of a file, a built-in mesh or a built-in solid. Throws InputError if `mesh`
/// names none of these, or an option cannot be met.
MeshSolid make_mesh_solid(const std::string& mesh, const MeshOptions& options);
/// Makes the compound of a mesh in memory, which `name` stands for in messages. Throws InputError.
MeshSolid make_mesh_solid(RawMesh mesh, const std::string& name, const MeshOptions& options);
/// Replaces the materials of all convexes, which are indices into `materials`, by these.
void set_materials(Compound& compound, const std::vector<MaterialIndex>& materials);
/// Wraps an existing compound, with the vertices and faces of its convexes.
MeshSolid as_mesh_solid(const std::string& name, Compound compound);
/// Returns true if two appearances are equal; pictures are compared by their bytes.
bool same_appearance(const Appearance& a, const Appearance& b);

/// Returns true if `mesh` is no file and begins like a built-in solid ("box:1,1,1") or a built-in
/// mesh ("statue:80000").
bool is_built_in(const std::string& mesh);
/// Returns true if `mesh` is no file and begins like a built-in solid, which is made of convexes.
bool is_built_in_solid(const std::string& mesh);
/// Returns the mesh of a file, or a built-in mesh, without repairs. Throws InputError.
RawMesh make_raw_mesh(const std::string& mesh);
/// Returns the options of a decomposition. Throws InputError for wrong ones, before expensive work.
fracture::VacdOptions vacd_options(const MeshOptions& options);

}  // namespace sunder::scenes
