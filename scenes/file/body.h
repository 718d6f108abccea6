// Bodies made from meshes: what [[body]] in a scene may say, and what it becomes.
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

/// The keys that name a mesh and say how it is decomposed.
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
/// Reads the key of the table that gives parts of a mesh materials by name. Throws InputError.
void read_named_materials(const Value& table, std::span<const Material> materials, MeshTable& mesh);

/// The other keys of [[body]], but for its place (placement.h).
struct BodyTable {
  std::string name;
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  Anchored anchored = Anchored::kNone;
};
const Keys<BodyTable>& body_keys();

/// A mesh in its own coordinates, of its material. Files are sought from `folder` on,
/// decompositions kept in the cache (mesh_cache.h), and the scene's paints and warnings are
/// appended to. Throws InputError without a place.
Compound read_compound(const MeshTable& given, const std::filesystem::path& folder,
                       std::vector<Paint>& paints, std::vector<std::string>& warnings);
/// The middle of a compound's lowest level.
Vec3 foot_of(const Compound& compound);

/// What a [[body]] is.
struct Body {
  std::string name;           ///< Empty: none was given.
  std::string usual;          ///< In place of it: its mesh's name.
  std::vector<Solid> solids;  ///< One for each part of a copy that hangs together, without names.
};
/// Throws InputError.
Body read_body(const Value& table, std::span<const Material> materials,
               const std::filesystem::path& folder, std::vector<Paint>& paints,
               std::vector<std::string>& warnings);

}  // namespace sunder::scenes
