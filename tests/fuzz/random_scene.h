// Scenes by chance, as files that a user could have written.
#pragma once

#include <cstdint>
#include <string>

namespace sunder::fuzz {

/// A scene file and how it is run.
struct RandomScene {
  std::string name;  ///< Of the shipped scene that it is, or "made".
  std::string text;
  std::string file;  ///< What it is called when it is read: its folder is where meshes are.
  std::string preset;
};

/// The same for the same seed: one of those shipped, or walls, columns, glass, meshes and what
/// hangs in joints, somewhere; shots, blasts and drives; in the plane at times. All of it is
/// allowed.
RandomScene random_scene(std::uint64_t seed);

}  // namespace sunder::fuzz
