// Loads scene files, lists the scenes that come with the program, and finds materials by name.
//
// Read first: parse_scene() in load.cpp, then file/schema.h for the tables and keys of a file.
// README.md lists every key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"

#ifndef SUNDER_SCENES_FOLDER  // defined by the CMake target for targets that link it
#define SUNDER_SCENES_FOLDER ""
#endif

namespace sunder::scenes {

/// Changes to a scene without editing its file.
struct LoadOptions {
  std::string preset = "realtime";  ///< draft | realtime | accurate | reference
  std::vector<std::string> set;     ///< Assignments KEY=VALUE with a dotted key of the file.
};

/// Returns the file itself if there is one, otherwise the file of the scene of this name in the
/// catalogue, scenes_folder(folder, program). Throws InputError that lists the scenes if there is
/// neither.
std::filesystem::path scene_file(const std::string& file_or_name,
                                 const std::filesystem::path& folder = SUNDER_SCENES_FOLDER,
                                 const std::filesystem::path& program = {});
/// Loads scene_file(). Throws InputError that names file, line, key and the allowed values.
Scene load_scene(const std::string& file_or_name, const LoadOptions& options = {},
                 const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);
/// Returns the scene that a text describes. Errors name `file`, its stem is the scene's name, and
/// the files that the scene names are sought in its folder. Throws InputError.
Scene parse_scene(const std::string& text, const std::string& file,
                  const LoadOptions& options = {});

/// Returns the materials that every scene file starts from: brick, concrete, glass, steel and so on
/// (scenes/materials.toml). For scenes made in code.
std::vector<Material> builtin_materials();
/// Returns the material of this name. Throws InputError that lists the materials if there is none.
MaterialIndex material_named(const Scene& scene, const std::string& name);

/// A scene that comes with the program.
struct CatalogEntry {
  std::string name;
  std::filesystem::path file;
  std::string description;
};
/// Returns the scenes that come with the program, sorted by name.
std::vector<CatalogEntry> catalog(const std::filesystem::path& folder = SUNDER_SCENES_FOLDER);
/// Returns the folder of the catalogue: share/sunder/scenes beside `program`, the running one
/// unless it is named, if that is installed; scenes/ of the source tree if the program is in a
/// folder of one, such as build/; otherwise `folder`, which is the one installed with the library,
/// or that of the source tree in which the program was built. Throws InputError if none exists.
std::filesystem::path scenes_folder(const std::filesystem::path& folder = SUNDER_SCENES_FOLDER,
                                    const std::filesystem::path& program = {});

/// Returns every table and key of a scene file with unit, default and allowed values, as Markdown.
std::string key_reference();

}  // namespace sunder::scenes
