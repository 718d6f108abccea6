// Scene files become scenes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/world/scene.h"

namespace sunder::scenes {

/// How the user changes a scene without editing it.
struct LoadOptions {
  std::string preset = "realtime";  ///< draft | realtime
  std::vector<std::string> set;     ///< key=value, a dotted key of the file.
};

/// Loads a file, or the scene of that name from the catalogue. Throws InputError naming file,
/// line, key, and what is allowed.
Scene load_scene(const std::string& file_or_name, const LoadOptions& options);

struct CatalogEntry {
  std::string name;
  std::filesystem::path file;
  std::string description;
};
/// The scenes that come with the program, by name.
std::vector<CatalogEntry> catalog();

}  // namespace sunder::scenes
