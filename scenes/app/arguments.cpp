#include "scenes/app/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include "engine/base/check.h"
#include "scenes/file/keys.h"

namespace sunder::app {
namespace {

/// Returns the finite numbers of a text such as "1,2.5,3"; none if it has anything else.
std::vector<double> numbers(std::string_view text, char between) {
  std::vector<double> found;
  for (bool more = true; more;) {
    const std::size_t end = std::min(text.find(between), text.size());
    more = end < text.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + end, number);
    if (error != std::errc() || stop != text.data() + end || !std::isfinite(number)) return {};
    found.push_back(number);
    text.remove_prefix(more ? end + 1 : end);
  }
  return found;
}

/// A pattern "kind:sizes" while it is parsed.
struct Spec {
  const std::string& text;
  std::vector<double> sizes;

  [[noreturn]] void refuse(const std::string& expected) const {
    throw InputError("--pattern " + text + ": expected " + expected);
  }
  void need(bool right_count) const {
    if (!right_count) refuse(kPatternHelp);
  }
  double real(std::size_t i, double low, double high, const char* name,
              bool is_whole = false) const {
    if (sizes[i] < low || sizes[i] > high || (is_whole && sizes[i] != std::floor(sizes[i]))) {
      refuse(std::string(name) + " to be a " + (is_whole ? "whole " : "") + "number from " +
             scenes::format(low) + " to " + scenes::format(high));
    }
    return sizes[i];
  }
  int whole(std::size_t i, double low, double high, const char* name) const {
    return static_cast<int>(real(i, low, high, name, true));
  }
};

PatternSpec parse_built_in(const std::string& text, const std::string& kind) {
  using Kind = PatternSpec::Kind;
  const Spec spec{
      text, numbers(std::string_view(text).substr(kind.size() + 1), kind == "web" ? 'x' : ',')};
  const std::size_t count = spec.sizes.size();
  PatternSpec pattern;
  if (kind == "voronoi") {
    spec.need(count == 1 || count == 2);
    pattern.kind = Kind::kVoronoi;
    pattern.cells = spec.whole(0, 1, 5000, "N");
    if (count == 2) pattern.falloff = spec.real(1, 1, 10, "FALLOFF");
  } else if (kind == "web") {
    spec.need(count == 2);
    pattern.kind = Kind::kWeb;
    pattern.rings = spec.whole(0, 1, 100, "RINGS");
    pattern.spokes = spec.whole(1, 3, 200, "SPOKES");
  } else if (kind == "radial") {
    spec.need(count == 1);
    pattern.kind = Kind::kRadial;
    pattern.cells = spec.whole(0, 3, 200, "N");
  } else if (kind == "brick") {
    spec.need(count == 3);
    pattern.kind = Kind::kBrick;
    for (std::size_t i = 0; i < 3; ++i) {
      pattern.brick_m[static_cast<Eigen::Index>(i)] = spec.real(i, 1e-9, 1e9, "X, Y and Z");
    }
  } else if (kind == "slabs") {
    spec.need(count == 1);
    pattern.kind = Kind::kSlabs;
    pattern.cells = spec.whole(0, 1, 1000, "N");
  } else if (kind == "grid") {
    spec.need(count == 1);
    pattern.kind = Kind::kGrid;
    pattern.cells = spec.whole(0, 1, 30, "N");
  } else {
    spec.refuse(kPatternHelp);
  }
  return pattern;
}

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
  const std::vector<double> found = numbers(text, ',');
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

PatternSpec parse_pattern(const std::string& text) {
  if (text.ends_with(".obj") || std::filesystem::is_regular_file(text)) {
    PatternSpec pattern;
    pattern.kind = PatternSpec::Kind::kFile;
    pattern.file = text;
    return pattern;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw InputError("--pattern " + text + ": expected " + kPatternHelp);
  }
  return parse_built_in(text, text.substr(0, colon));
}

}  // namespace sunder::app
