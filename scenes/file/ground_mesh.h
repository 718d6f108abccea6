// Ground meshes: the keys of [[ground.mesh]] in a scene file, and the triangles made of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// The keys of [[ground.mesh]], except for its placement (placement.h).
struct GroundMeshTable {
  std::optional<std::string> mesh;
  double scale = 1;
  std::optional<HeightGrid> heights_m;
  std::optional<double> hills_m;
  double hill_length_m = 12;
  double width_m = 40, depth_m = 40;
  std::uint64_t seed = 1;
  double spacing_m = 1;
  std::optional<std::string> material;
};
const Keys<GroundMeshTable>& ground_mesh_keys();

/// Appends the meshes of a [[ground.mesh]], and their material if they name none, to a scene that
/// has its materials, [ground] and [view]. Files are relative to `folder`. Throws InputError.
void read_ground_mesh(const Value& table, const std::filesystem::path& folder, Scene& scene);

}  // namespace sunder::scenes
