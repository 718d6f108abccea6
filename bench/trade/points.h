// The points of a study: how exactly a scene is run, from coarse to fine.
#pragma once

#include <string>
#include <vector>

namespace sunder::bench {

/// The point that all others are held against.
inline constexpr const char* kLimit = "limit";

struct StudyPoint {
  std::string name;
  std::string preset;
  std::vector<std::string> set;  ///< key=value, over the preset.

  bool is_preset() const { return name == preset && set.empty(); }
  bool is_limit() const { return name == kLimit; }
};

/// Points as grid.txt describes them; the limit is the last, that of default_points() if the text
/// has none. Throws InputError naming file and line.
std::vector<StudyPoint> parse_points(const std::string& text, const std::string& file);
std::vector<StudyPoint> default_points();

/// For each preset among the points, the same with this key=value of the scene, before the limit:
/// what it costs to model something, and what it is worth.
void add_switch(std::vector<StudyPoint>& points, const std::string& assignment);

}  // namespace sunder::bench
