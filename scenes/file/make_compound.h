// Compounds made in code: of convex parts, or of a mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::scenes {

/// A compound of parts: those that touch or overlap hold together. Throws InputError if too many
/// overlap.
Compound make_compound(std::vector<Part> parts);

/// How a file's mesh is decomposed; what is built in is as it is.
struct MeshOptions {
  std::string nodes;  ///< How many, or a file of x y z a line; empty: as many as are usual.
  std::uint32_t convexes = 0;  ///< At most so many; 0: what the nodes make.
  std::string fit = "hull:24";
  std::string repair = "auto";   ///< off: a mesh that needs repair is refused.
  double scale = 1;              ///< Metres a unit of the file.
  std::optional<double> size_m;  ///< In place of it: the longest side of the bounding box.
  /// Of what else its parts are made that a file has a name for: a group or object of it, or one of
  /// its own materials. Where several names are given that a polygon has, the narrower counts.
  std::vector<std::pair<std::string, MaterialIndex>> materials{};
  /// Where to append how the file paints its surface, in place of what its materials look like:
  /// what a scene has, whose paints are these. Null: it looks as its materials do.
  std::vector<Paint>* paints = nullptr;
  /// Warnings about the paints are appended to this, each once; null: to nothing.
  std::vector<std::string>* warnings = nullptr;
  bool cached = false;  ///< Whether a decomposition is kept, and recalled (mesh_cache.h).
  /// Told of each step when it begins, and then of the share of all work done; may be empty.
  std::function<void(const char* step, double share)> progress{};
};

/// A compound of a material (and those of the options) from a mesh: a file (.obj .ply .stl .off
/// .gltf .glb), repaired and decomposed, a built-in mesh, "statue:80000", likewise, or a built-in
/// solid such as "torus:1,0.3". Throws InputError if `mesh` names nothing, or what is asked of it
/// cannot be.
Compound make_compound(const std::string& mesh, MaterialIndex material,
                       const MeshOptions& options = {});

/// The connected parts of a compound, each to be a solid; itself if it is one.
std::vector<Compound> split_islands(const Compound& compound);

}  // namespace sunder::scenes
