// Parses and checks arguments of several numbers and files.
#pragma once

#include <string>
#include <vector>

#include "engine/base/types.h"
#include "render/sinks.h"

namespace sunder::app {

/// Parses "x,y,z". Throws InputError that names `flag` for anything else.
Vec3 parse_point(const std::string& flag, const std::string& text);

/// Parses "WIDTHxHEIGHT" of --size into the options. Throws InputError for anything else.
void parse_size(const std::string& text, render::RenderOptions& options);

/// A file that an option names.
struct NamedFile {
  std::string option;
  std::string path;
  bool replaces_folder = false;  ///< True if writing an output deletes all files in its folder.
};
/// Throws InputError if an output would overwrite an input, by whatever path, or two outputs are
/// one file. Empty paths and "-" are ignored, as are devices and pipes as outputs.
void check_files(const std::vector<NamedFile>& writes, const std::vector<NamedFile>& reads);

}  // namespace sunder::app
