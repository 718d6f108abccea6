#include "scenes/app/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include "engine/base/check.h"
#include "scenes/file/keys.h"
#include "scenes/solid_break.h"

namespace sunder::app {
namespace {

bool is_none(const std::string& path) { return path.empty() || path == "-"; }

/// Returns true if writing the output would overwrite `file`, or delete it with its folder.
bool is_overwritten(const std::string& file, const NamedFile& output) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(output.path), error);
  const fs::path other = fs::weakly_canonical(fs::absolute(file), error);
  if (fs::exists(place, error) && !fs::is_regular_file(place, error) &&
      !fs::is_directory(place, error))
    return false;
  if (place == other || fs::equivalent(place, other, error)) return true;
  const fs::path folder = place.has_filename() ? place : place.parent_path();
  return output.replaces_folder && other.parent_path() == folder;
}

}  // namespace

void check_files(const std::vector<NamedFile>& writes, const std::vector<NamedFile>& reads) {
  for (std::size_t i = 0; i < writes.size(); ++i) {
    const NamedFile& output = writes[i];
    if (is_none(output.path)) continue;
    const std::string name = output.option + " " + output.path;
    if (output.option != "-o" && std::filesystem::is_directory(output.path))
      throw InputError(name + ": is a folder; give a file in it");
    for (const NamedFile& input : reads) {
      const bool is_there = !is_none(input.path) && std::filesystem::exists(input.path);
      if (!is_there || !is_overwritten(input.path, output)) continue;
      throw InputError(name + ": would overwrite the input of " + input.option + "; give another " +
                       (output.replaces_folder ? "place" : "file"));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (is_none(writes[j].path) || !is_overwritten(writes[j].path, output)) continue;
      throw InputError(name + ": is also the output of " + writes[j].option +
                       "; give another file");
    }
  }
}

Vec3 parse_point(const std::string& flag, const std::string& text) {
  const std::vector<double> found = scenes::numbers_in(text, ',');
  if (found.size() != 3) {
    throw InputError(flag + " " + text + ": expected three numbers, x,y,z, without spaces");
  }
  return {found[0], found[1], found[2]};
}

void parse_size(const std::string& text, render::RenderOptions& options) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &options.width, &options.height, &rest) != 2 ||
      options.width < 16 || options.height < 16 || options.width > 8192 || options.height > 8192) {
    throw InputError("--size " + text +
                     ": expected WIDTHxHEIGHT, each from 16 to 8192, and even for a video");
  }
}

}  // namespace sunder::app
