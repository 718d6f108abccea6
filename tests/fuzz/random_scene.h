// Random scenes, as the text of a scene file.
#pragma once

#include <cstdint>
#include <string>

namespace sunder::fuzz {

/// Text of a scene file, and the options of its run.
struct RandomScene {
  std::string name;  ///< Name of the shipped scene, or "made".
  std::string text;
  std::string file;  ///< Path of the scene file; meshes are in its folder.
  std::string preset;
};

/// Returns the valid scene of a seed: a shipped scene with random shots, blasts and wrecking balls;
/// or a scene of random structures, meshes and jointed balls; or a planar scene.
RandomScene random_scene(std::uint64_t seed);

}  // namespace sunder::fuzz
