// Ground that is no plane: what [[ground.mesh]] in a scene may say, and what it becomes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// The keys of [[ground.mesh]], but for its place (placement.h).
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

/// Adds what a [[ground.mesh]] is to the ground of a scene whose materials and [ground] are known;
/// files are sought from `folder` on. Throws InputError.
void read_ground_mesh(const Value& table, const std::filesystem::path& folder, Scene& scene);

}  // namespace sunder::scenes
