// Bodies made from meshes: the keys of [[body]] in a scene file, and the solids made of them.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {

enum class RepairChoice { kAuto, kOff };
enum class LookChoice { kFile, kMaterial };

/// The keys that name a mesh and set its decomposition.
struct MeshTable {
  std::string mesh;
  double scale = 1;
  std::optional<double> size_m;
  CountOrFile nodes;
  std::uint32_t convexes = 0;
  std::string fit = "hull:24";
  RepairChoice repair = RepairChoice::kAuto;
  MaterialRef material{"concrete", {}};
  LookChoice look = LookChoice::kFile;
  std::vector<std::pair<std::string, MaterialIndex>> materials;  ///< read_named_materials()
};
const Keys<MeshTable>& mesh_keys();
/// Reads the key `materials`, which assigns materials to named parts of a mesh. Throws InputError.
void read_named_materials(const Value& table, std::span<const Material> materials, MeshTable& mesh);

/// The other keys of [[body]], except for its placement (placement.h).
struct BodyTable {
  std::string name;
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  Anchored anchored = Anchored::kNone;
};
const Keys<BodyTable>& body_keys();

/// Returns the compound of a mesh in the mesh's own coordinates, with its materials. Files are
/// relative to `folder`, decompositions are cached (mesh_cache.h), and the appearances in the file
/// and warnings are appended to `appearances` and `warnings` of the scene. Throws InputError
/// without file and line.
Compound read_compound(const MeshTable& given, const std::filesystem::path& folder,
                       std::vector<Appearance>& appearances, std::vector<std::string>& warnings);
/// Returns the middle of the lower face of a compound's bounding box.
Vec3 foot_of(const Compound& compound);

/// The solids of a [[body]].
struct Body {
  std::string name;           ///< The name given; empty if there is none.
  std::string default_name;   ///< Name of the mesh, for where none is given.
  std::vector<Solid> solids;  ///< One for each island of each copy, without names.
};
/// Reads a [[body]]. Throws InputError.
Body read_body(const Value& table, std::span<const Material> materials,
               const std::filesystem::path& folder, std::vector<Appearance>& appearances,
               std::vector<std::string>& warnings);

}  // namespace sunder::scenes
