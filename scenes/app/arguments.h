// Arguments that are more than a word or a number.
#pragma once

#include <string>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/material.h"
#include "render/sinks.h"

namespace sunder::app {

/// "x,y,z"; throws InputError naming `flag` for anything else.
Vec3 parse_point(const std::string& flag, const std::string& text);

/// Puts the "WIDTHxHEIGHT" of --size into the options. Throws InputError for anything else.
void parse_size(const std::string& text, render::RenderOptions& options);

/// A file that an option names.
struct NamedFile {
  std::string option;
  std::string path;
  bool replaces_folder = false;  ///< Of an output: all that lies in its folder goes.
};
/// Throws InputError if something that is to be written is what is read, by whatever name, or if
/// two outputs are one file. Empty names and "-" are none; devices and pipes stay what they are.
void check_files(const std::vector<NamedFile>& writes, const std::vector<NamedFile>& reads);

/// What parse_pattern() understands.
inline constexpr const char* kPatternHelp =
    "voronoi:N[,FALLOFF] | web:RINGSxSPOKES | radial:N | brick:X,Y,Z | slabs:N | grid:N (N^3 "
    "cells) | an .obj file of convex cells, one a group";
/// A pattern for --pattern. Throws InputError that says what is allowed.
PatternSpec parse_pattern(const std::string& text);

}  // namespace sunder::app
