// What a MESH on the command line, or `mesh = "..."` in a scene, becomes.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/repair.h"
#include "engine/world/compound.h"

namespace sunder::scenes {

/// A compound, and what it was made of.
struct MeshSolid {
  Compound compound;
  std::string name;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  bool closed = true;  ///< As it was given.
  std::vector<Repair> repairs;
  double prepare_ms = 0;
};

/// Throws InputError if `mesh` names nothing.
MeshSolid make_mesh_solid(const std::string& mesh);
/// A compound that is there already.
MeshSolid as_mesh_solid(const std::string& name, Compound compound);

}  // namespace sunder::scenes
