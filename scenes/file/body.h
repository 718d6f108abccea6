// Bodies made from meshes: what [[body]] in a scene may say, and what it becomes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {

enum class RepairChoice { kAuto, kOff };

/// The keys of [[body]].
struct BodyTable {
  std::string mesh;
  std::string name;
  double scale = 1;
  std::optional<double> size_m;
  CountOrFile nodes;
  std::uint32_t convexes = 0;
  std::string fit = "hull:24";
  RepairChoice repair = RepairChoice::kAuto;
  MaterialRef material{"concrete", {}};
  Vec3 position = Vec3::Zero();
  Vec3 rotation_rad = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  Anchored anchored = Anchored::kNone;
};
const Keys<BodyTable>& body_keys();

/// What it is called if nothing is given: its mesh's name.
std::string default_name(const BodyTable& given);
/// The solids that a body is, one for each part that hangs together, without names. Files are
/// sought from `folder` on, decompositions kept in the cache (mesh_cache.h). Throws InputError
/// without a place.
std::vector<Solid> make_body(const BodyTable& given, const std::filesystem::path& folder);

/// About x, then y, then z.
Quat rotation(const Vec3& angles_rad);

}  // namespace sunder::scenes
