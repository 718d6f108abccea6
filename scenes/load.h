// Scene files become scenes, and materials are found by name.
//
// Read first: load_scene() in load.cpp, then schema.h for what a file may say. README.md lists
// every key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"

#ifndef SUNDER_SCENES_FOLDER  // given by the CMake target to those who link it
#define SUNDER_SCENES_FOLDER ""
#endif

namespace sunder::scenes {

/// How the user changes a scene without editing it.
struct LoadOptions {
  std::string preset = "realtime";  ///< draft | realtime | accurate | reference
  std::vector<std::string> set;     ///< key=value, a dotted key of the file.
};

/// The file itself, or that of the scene of this name in the catalogue in `folder`
/// (scenes_folder()). Throws InputError naming those there are.
std::filesystem::path scene_file(const std::string& file_or_name,
                                 const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);
/// Loads scene_file(). Throws InputError naming file, line, key, and what is allowed.
Scene load_scene(const std::string& file_or_name, const LoadOptions& options = {},
                 const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);
/// The scene that a text describes; `file` is what errors call it, its stem the scene's name.
Scene parse_scene(const std::string& text, const std::string& file,
                  const LoadOptions& options = {});

/// The library of materials that every scene file starts from: brick, concrete, glass, steel and
/// so on (scenes/materials.toml), for scenes made in code.
std::vector<Material> builtin_materials();
/// The material of that name in a scene. Throws InputError, naming those there are.
MaterialIndex material_named(const Scene& scene, const std::string& name);

struct CatalogEntry {
  std::string name;
  std::filesystem::path file;
  std::string description;
};
/// The scenes that come with the program, by name.
std::vector<CatalogEntry> catalog(const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);
/// The folder they lie in: that beside the running program if it is an installed one, else
/// `folder`: where they were installed with the library, or the source tree. Throws InputError if
/// there is neither.
std::filesystem::path scenes_folder(const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);

/// Every table and key of a scene file with unit, default and what is allowed, as Markdown.
std::string key_reference();

}  // namespace sunder::scenes
