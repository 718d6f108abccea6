// Points of a study: the settings at which a scene is run, from coarse to fine.
#pragma once

#include <string>
#include <vector>

namespace sunder::scenes {

/// Name of the point that is the reference for all others, and of the same with steps of twice and
/// four times the length, which show whether it depends on its step.
inline constexpr const char* kLimit = "limit";
inline constexpr const char* kLimit2h = "limit_2h";
inline constexpr const char* kLimit4h = "limit_4h";

struct StudyPoint {
  std::string name;
  std::string preset;
  std::vector<std::string> set;  ///< key=value, over the preset.

  bool is_preset() const { return name == preset && set.empty(); }
  bool is_limit() const { return name == kLimit; }
  bool is_coarser_limit() const { return name == kLimit2h || name == kLimit4h; }
};

/// Parses points in the format of grid.txt. The limit becomes the last point; without one in the
/// text, it is that of default_points(). Throws InputError naming file and line.
std::vector<StudyPoint> parse_points(const std::string& text, const std::string& file);
std::vector<StudyPoint> default_points();

/// Inserts before the limit, for each preset among the points, a copy with this key=value of the
/// scene, to measure cost and accuracy of a feature.
void add_switch(std::vector<StudyPoint>& points, const std::string& assignment);

/// Inserts before the limit the limit with steps of twice and four times the length, unless such a
/// step is longer than a frame or a point has that name. `set` has the keys set for all points.
void add_coarser_limits(std::vector<StudyPoint>& points, const std::vector<std::string>& set);

}  // namespace sunder::scenes
