#include "scenes/trade/points.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <set>
#include <sstream>

#include "engine/base/check.h"
#include "engine/model/checks/ranges.h"
#include "scenes/file/schema.h"
#include "scenes/trade/grid.h"

namespace sunder::scenes {
namespace {

bool may_be_in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || std::string("._+=-").find(c) < 5;
}

void check_name(const std::string& name, const std::string& where) {
  if (!std::all_of(name.begin(), name.end(), may_be_in_name) || name.front() == '.') {
    throw InputError(where + ": '" + name +
                     "' is not a valid name of a point; allowed: letters, digits and . _ + = -");
  }
}

void check_preset(const std::string& preset, const std::string& where) {
  std::string names;
  for (const Preset& known : presets()) {
    if (known.name == preset) return;
    names += (names.empty() ? "" : ", ") + std::string(known.name);
  }
  throw InputError(where + ": unknown preset '" + preset + "'; allowed: " + names);
}

/// Parses a line; the point has no name if the line is empty.
StudyPoint parse_line(const std::string& line, const std::string& where) {
  std::istringstream words(line.substr(0, line.find('#')));
  StudyPoint point;
  if (!(words >> point.name)) return {};
  check_name(point.name, where);
  if (!(words >> point.preset)) {
    throw InputError(where + ": expected NAME PRESET KEY=VALUE...");
  }
  check_preset(point.preset, where);
  for (std::string word; words >> word;) {
    if (word.find('=') == std::string::npos) {
      throw InputError(where + ": expected KEY=VALUE, got '" + word + "'");
    }
    point.set.push_back(word);
  }
  return point;
}

/// Returns the points in the order of the text, except that the limit is last.
std::vector<StudyPoint> parse_lines(const std::string& text, const std::string& file) {
  std::vector<StudyPoint> points;
  std::set<std::string> seen;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = file + ":" + std::to_string(++number);
    StudyPoint point = parse_line(line, where);
    if (point.name.empty()) continue;
    if (!seen.insert(point.name).second) {
      throw InputError(where + ": duplicate point '" + point.name + "'");
    }
    points.push_back(std::move(point));
  }
  std::stable_partition(points.begin(), points.end(),
                        [](const StudyPoint& point) { return !point.is_limit(); });
  return points;
}

/// Returns the step of a point, which is not checked yet; 0 if it is no number.
double step_of(const StudyPoint& point, const std::vector<std::string>& set) {
  constexpr const char* kStep = "accuracy.dt_s=";
  double dt_s = 0;
  for (const Preset& preset : presets()) {
    if (preset.name == point.preset) dt_s = preset.accuracy.dt_s;
  }
  for (const std::vector<std::string>* keys : {&set, &point.set}) {
    for (const std::string& assignment : *keys) {
      if (!assignment.starts_with(kStep)) continue;
      const char* end = assignment.data() + assignment.size();
      dt_s = 0;
      std::from_chars(assignment.data() + std::strlen(kStep), end, dt_s);
    }
  }
  return dt_s;
}

}  // namespace

std::vector<StudyPoint> parse_points(const std::string& text, const std::string& file) {
  std::vector<StudyPoint> points = parse_lines(text, file);
  if (points.empty() || points.front().is_limit()) {
    throw InputError(file + ": has no point besides the limit; add at least one");
  }
  if (!points.back().is_limit()) points.push_back(default_points().back());
  return points;
}

std::vector<StudyPoint> default_points() { return parse_lines(grid::grid_txt, "grid.txt"); }

void add_switch(std::vector<StudyPoint>& points, const std::string& assignment) {
  const std::string where = "--switch " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
    throw InputError(where + ": expected KEY=VALUE");
  }
  check_name(assignment, where);
  std::vector<StudyPoint> switched;
  for (const StudyPoint& point : points) {
    if (!point.is_preset()) continue;
    switched.push_back({point.name + "+" + assignment, point.preset, {assignment}});
  }
  points.insert(points.end() - 1, switched.begin(), switched.end());
}

void add_coarser_limits(std::vector<StudyPoint>& points, const std::vector<std::string>& set) {
  const StudyPoint limit = points.back();
  const double dt_s = step_of(limit, set);
  for (const auto& [name, factor] : {std::pair(kLimit4h, 4.0), {kLimit2h, 2.0}}) {
    const double step_s = factor * dt_s;
    if (!(step_s > 0 && step_s <= ranges::kFileStep_s.high)) continue;
    if (std::ranges::find(points, name, &StudyPoint::name) != points.end()) continue;
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, step_s).ptr;
    StudyPoint coarser{name, limit.preset, limit.set};
    coarser.set.push_back("accuracy.dt_s=" + std::string(digits, end));
    points.insert(points.end() - 1, std::move(coarser));
  }
}

}  // namespace sunder::scenes
