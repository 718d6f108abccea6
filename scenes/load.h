// Scene files become scenes.
//
// Read first: load_scene() in load.cpp, then schema.h for what a file may say. README.md lists
// every key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"

namespace sunder::scenes {

/// How the user changes a scene without editing it.
struct LoadOptions {
  std::string preset = "realtime";  ///< draft | realtime | accurate | reference
  std::vector<std::string> set;     ///< key=value, a dotted key of the file.
};

/// Loads a file, or the scene of that name from the catalogue. Throws InputError naming file,
/// line, key, and what is allowed.
Scene load_scene(const std::string& file_or_name, const LoadOptions& options);
/// The scene that a text describes; `file` is what errors call it, its stem the scene's name.
Scene parse_scene(const std::string& text, const std::string& file, const LoadOptions& options);

struct CatalogEntry {
  std::string name;
  std::filesystem::path file;
  std::string description;
};
/// The scenes that come with the program, by name.
std::vector<CatalogEntry> catalog();
/// The folder they lie in: beside the installed program, else in the source tree.
std::filesystem::path scenes_folder();

/// Every table and key of a scene file with unit, default and what is allowed, as Markdown.
std::string key_reference();

}  // namespace sunder::scenes
