// Finds scene files by name, and lists the catalogue.
#include <algorithm>

#include "engine/base/check.h"
#include "engine/io/file_ending.h"
#include "scenes/file/keys.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

/// Returns the scene files of a catalogue, sorted by stem. They lie in folders within `folder`;
/// files beside these folders, such as materials.toml, are no scenes.
std::vector<fs::path> catalog_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& group : fs::directory_iterator(folder)) {
    if (!group.is_directory()) continue;
    for (const fs::directory_entry& file : fs::directory_iterator(group)) {
      if (file.path().extension() == ".toml") files.push_back(file.path());
    }
  }
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return a.stem() < b.stem(); });
  return files;
}

/// Returns the description in a scene file, without building the scene.
std::string description(const fs::path& file) {
  const Value document = parse_toml(read_text(file, file_kinds::kScene), file.string());
  const Value* scene = find(document, "scene");
  const Value* text = scene ? find(as_table(*scene, "[scene]"), "description") : nullptr;
  const std::string* line = text ? std::get_if<std::string>(&text->data) : nullptr;
  return line ? *line : "(no description)";
}

}  // namespace

fs::path scenes_folder(const fs::path& folder, const fs::path& program) {
  std::error_code ignored;
  const fs::path file = program.empty() ? fs::read_symlink("/proc/self/exe", ignored) : program;
  const fs::path above = file.parent_path().parent_path();
  const fs::path installed = above / "share/sunder/scenes";
  if (fs::is_directory(installed)) return installed;
  // A program in the build folder of a source tree has the scenes of that tree, wherever it is now.
  if (fs::is_regular_file(above / "scenes/materials.toml")) return above / "scenes";
  if (fs::is_directory(folder)) return folder;
  throw InputError("no catalogue of scenes found: neither " + installed.string() +
                   (folder.empty() ? "" : " nor " + folder.string()) +
                   " is a folder; give the path of a scene file");
}

fs::path scene_file(const std::string& file_or_name, const fs::path& folder,
                    const fs::path& program) {
  if (fs::is_regular_file(file_or_name) || has_ending(file_or_name, ".toml")) return file_or_name;
  std::vector<std::string> names;
  try {
    for (const fs::path& file : catalog_files(scenes_folder(folder, program))) {
      if (file.stem() == file_or_name) return file;
      names.push_back(file.stem().string());
    }
  } catch (const InputError& error) {
    throw InputError(file_or_name + ": no such file, and " + error.what());
  }
  if (fs::is_directory(file_or_name))
    throw InputError(file_or_name + ": is a folder; give a scene file in it");
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw InputError(file_or_name + ": no such file, and no scene of this name" +
                   did_you_mean(file_or_name, views) + "; scenes: " + join(views));
}

std::vector<CatalogEntry> catalog(const fs::path& folder) {
  std::vector<CatalogEntry> entries;
  for (const fs::path& file : catalog_files(scenes_folder(folder))) {
    entries.push_back({file.stem().string(), file, description(file)});
  }
  return entries;
}

Scene load_scene(const std::string& file_or_name, const LoadOptions& options,
                 const fs::path& folder) {
  const fs::path file = scene_file(file_or_name, folder);
  return parse_scene(read_text(file, file_kinds::kScene), file.string(), options);
}

}  // namespace sunder::scenes
