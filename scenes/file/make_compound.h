// Makes compounds from convex parts or from a mesh, for scenes made in code.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::scenes {

/// Returns a compound of parts, which are bonded where they touch and joined by ghosts where they
/// overlap. Throws InputError if too many overlap.
Compound make_compound(std::vector<Part> parts);

/// Options of the repair and decomposition of a mesh. Built-in solids need neither.
struct MeshOptions {
  std::string nodes;  ///< Number of nodes, or a file with x y z on each line; empty: automatic.
  std::uint32_t convexes = 0;  ///< Most convexes; 0: as many as the nodes give.
  std::string fit = "hull:24";
  std::string repair = "auto";   ///< "off" throws InputError for a mesh that needs repair.
  double scale = 1;              ///< Metres for each unit of the file.
  std::optional<double> size_m;  ///< Longest side of the bounding box, in place of `scale`.
  /// Materials of named parts of the file: groups, objects or materials of the file. Of several
  /// given names that a polygon has, the most specific decides.
  std::vector<std::pair<std::string, MaterialIndex>> materials{};
  /// The appearances in the file are appended to this, and faces are drawn with them: pass the
  /// scene's Scene::appearances. Null: faces are drawn as their materials.
  std::vector<Appearance>* appearances = nullptr;
  /// Warnings about appearances are appended to this, each once; null: there are none.
  std::vector<std::string>* warnings = nullptr;
  /// The compound of a mesh far from its origin stays at the origin, where doubles are fine enough.
  bool centered = false;
  bool cached = false;  ///< True if decompositions are cached on disk (mesh_cache.h).
  /// Called at the start of each step, and with the fraction of all work done; may be empty.
  std::function<void(const char* step, double share)> progress{};
};

/// Returns a compound of a mesh, of `material` and those of the options. `mesh` names a file (.obj
/// .ply .stl .off .gltf .glb) or a built-in mesh ("statue:80000"), which is repaired and
/// decomposed, or a built-in solid ("torus:1,0.3"). Throws InputError if `mesh` names none of
/// these, or an option cannot be met.
Compound make_compound(const std::string& mesh, MaterialIndex material,
                       const MeshOptions& options = {});

/// Returns the compound moved by a vector in R.
Compound moved(const Compound& compound, const Vec3& by);
/// Returns the islands of a compound, the connected parts, each of which is to be a solid.
std::vector<Compound> split_islands(const Compound& compound);

}  // namespace sunder::scenes
