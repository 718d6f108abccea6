// What a MESH on the command line, or `mesh = "..."` in a scene, becomes: a file is read, repaired
// and decomposed; a built-in solid is made.
//
// Read first: make_mesh_solid().
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/repair/repair.h"
#include "fracture/vacd/vacd.h"

namespace sunder::scenes {

/// How a file's mesh is decomposed; what is built in is as it is.
struct MeshOptions {
  std::string nodes;  ///< How many, or a file of them; empty: as fracture/vacd/vacd.h has it.
  std::uint32_t convexes = 0;  ///< At most so many; 0: what the nodes make.
  std::string fit = "hull:24";
  std::string repair = "auto";   ///< off: a mesh that needs repair is refused.
  double scale = 1;              ///< Metres a unit of the file.
  std::optional<double> size_m;  ///< In place of it: the longest side of the bounding box.
  bool cached = false;           ///< Whether a decomposition is kept, and recalled (mesh_cache.h).
  /// Told of each step when it begins, and then of the share of all work done; may be empty.
  std::function<void(const char* step, double share)> progress{};
};

/// A compound, and what it was made of.
struct MeshSolid {
  Compound compound;
  std::string name;
  std::size_t vertices = 0;  ///< As it was given, as are:
  std::size_t faces = 0;
  bool closed = true;
  std::vector<Repair> repairs;
  std::optional<fracture::VacdFigures> vacd;  ///< None for what is built in.
  double prepare_ms = 0;                      ///< All of it: reading, repairs and decomposition.
};

/// Throws InputError if `mesh` names nothing, or what is asked of it cannot be.
MeshSolid make_mesh_solid(const std::string& mesh, const MeshOptions& options);
/// A compound that is there already.
MeshSolid as_mesh_solid(const std::string& name, Compound compound);
/// Whether `mesh` is meant to name what is built in: "box:1,1,1".
bool names_built_in(const std::string& mesh);
/// Throws InputError unless the options can be meant; before work that takes long.
fracture::VacdOptions vacd_options(const MeshOptions& options);

}  // namespace sunder::scenes
