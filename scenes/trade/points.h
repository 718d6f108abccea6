// Points of a study: the settings at which a scene is run, from coarse to fine.
#pragma once

#include <string>
#include <vector>

namespace sunder::scenes {

/// Name of the point that is the reference for all others.
inline constexpr const char* kLimit = "limit";

struct StudyPoint {
  std::string name;
  std::string preset;
  std::vector<std::string> set;  ///< key=value, over the preset.

  bool is_preset() const { return name == preset && set.empty(); }
  bool is_limit() const { return name == kLimit; }
};

/// Parses points in the format of grid.txt. The limit becomes the last point; without one in the
/// text, it is that of default_points(). Throws InputError naming file and line.
std::vector<StudyPoint> parse_points(const std::string& text, const std::string& file);
std::vector<StudyPoint> default_points();

/// Inserts before the limit, for each preset among the points, a copy with this key=value of the
/// scene, to measure cost and accuracy of a feature.
void add_switch(std::vector<StudyPoint>& points, const std::string& assignment);

}  // namespace sunder::scenes
