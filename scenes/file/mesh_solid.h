// What a MESH on the command line, or `mesh = "..."` in a scene, becomes: a file is read, repaired
// and decomposed, and so is a built-in mesh; a built-in solid is made of convexes.
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

/// A compound, and what it was made of. Its materials are numbers: 0, and from 1 on those of
/// MeshOptions::materials. Its faces are marked by MeshOptions::paints, if at all.
struct MeshSolid {
  Compound compound;
  std::string name;
  std::size_t vertices = 0;  ///< As it was given, as are:
  std::size_t faces = 0;
  bool closed = true;
  std::vector<Repair> repairs;
  std::optional<fracture::VacdFigures> vacd;  ///< None for what is made of convexes.
  std::vector<std::string> warnings;          ///< Pictures that are not there.
  double prepare_ms = 0;                      ///< All of it: reading, repairs and decomposition.
};

/// Throws InputError if `mesh` names nothing, or what is asked of it cannot be.
MeshSolid make_mesh_solid(const std::string& mesh, const MeshOptions& options);
/// A compound that is there already.
MeshSolid as_mesh_solid(const std::string& name, Compound compound);
/// Returns true if two paints look alike; pictures are compared by their bytes.
bool same_paint(const Paint& a, const Paint& b);

/// Whether `mesh` is meant to name what is built in: "box:1,1,1", "statue:80000".
bool names_built_in(const std::string& mesh);
/// Whether it is meant to name a built-in solid, which is made of convexes: all but "statue:80000".
bool names_solid(const std::string& mesh);
/// A file's mesh, or a built-in one, as it is given. Throws InputError.
RawMesh make_raw_mesh(const std::string& mesh);
/// Throws InputError unless the options can be meant; before work that takes long.
fracture::VacdOptions vacd_options(const MeshOptions& options);

}  // namespace sunder::scenes
