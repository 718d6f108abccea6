#include "scenes/trade/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "engine/io/figures.h"

namespace sunder::scenes {
namespace {

/// Returns the number as text; empty for no value.
std::string digits(const std::optional<double>& value, int count = 9) {
  if (!value) return {};
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", count, *value);
  return text;
}

std::string decimals(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

/// Returns a field of a CSV file (RFC 4180).
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string safe = "\"";
  for (const char c : text) safe += c == '"' ? "\"\"" : std::string(1, c);
  return safe + "\"";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

const FigureError* find_error(const PointTrade& point, const std::string& name) {
  if (!point.compared) return nullptr;
  const auto at = std::ranges::find(point.compared->figures, name, &FigureError::name);
  return at == point.compared->figures.end() ? nullptr : &*at;
}

/// Returns the figure of the largest error of a point; null if it has none.
const FigureError* largest_of(const PointTrade& point) {
  return point.compared ? point.compared->largest() : nullptr;
}

/// Returns "drift 0.012 m": the name of a figure ends with its unit, or is one, as "pieces".
std::string format_difference(const FigureError& error) {
  const std::size_t space = error.name.rfind(' ');
  const std::string distance = digits(error.difference, 3);
  if (space == std::string::npos) return distance + " " + error.name;
  return error.name.substr(0, space) + " " + distance + error.name.substr(space);
}

/// Returns the names of all errors of all scenes.
std::set<std::string> error_names(const std::vector<SceneTrade>& scenes) {
  std::set<std::string> names;
  for (const SceneTrade& scene : scenes) {
    for (const PointTrade& point : scene.points) {
      if (!point.compared) continue;
      for (const FigureError& error : point.compared->figures) names.insert(error.name);
    }
  }
  return names;
}

/// Adds a value if it is finite, because JSON has no infinite numbers.
void put(Figures& figures, const std::string& place, const std::optional<double>& value) {
  if (value && std::isfinite(*value)) figures[place] = *value;
}

void put(Figures& figures, const std::string& at, const PointTrade& point) {
  figures[at + "/name"] = point.point.name;
  figures[at + "/preset"] = point.point.preset;
  for (std::size_t i = 0; i < point.point.set.size(); ++i) {
    figures[at + "/set/" + std::to_string(i)] = point.point.set[i];
  }
  figures[at + "/runs"] = std::int64_t{point.runs};
  figures[at + "/cost_ms"] = point.cost_ms;
  figures[at + "/wall_ms"] = point.wall_ms;
  figures[at + "/on_front"] = point.on_front;
  put(figures, at + "/error", point.error);
  put(figures, at + "/over_front", point.over_front);
  if (!point.failed.empty()) figures[at + "/failed"] = point.failed;
  if (!point.compared) return;
  figures[at + "/error_low"] = point.compared->interval.low;
  figures[at + "/error_high"] = point.compared->interval.high;
  figures[at + "/p"] = point.compared->p;
  figures[at + "/differs"] = point.compared->differs();
  for (std::size_t i = 0; i < point.compared->figures.size(); ++i) {
    const FigureError& error = point.compared->figures[i];
    const std::string place = at + "/errors/" + std::to_string(i);
    figures[place + "/name"] = error.name;
    figures[place + "/difference"] = error.difference;
    figures[place + "/spread"] = error.spread;
    figures[place + "/error"] = error.error;
    figures[place + "/p"] = error.p;
  }
}

}  // namespace

std::string trade_csv(const Trade& trade) {
  const std::set<std::string> names = error_names(trade.scenes);
  std::string csv =
      "scene,point,preset,set,runs,cost_ms,wall_ms,error,error_low,error_high,p,limit,largest,"
      "on_front,over_front,failed";
  for (const std::string& name : names) csv += "," + quoted(name);
  csv += "\n";
  for (const SceneTrade& scene : trade.scenes) {
    for (const PointTrade& point : scene.points) {
      const std::optional<PointError>& compared = point.compared;
      csv += quoted(scene.scene) + "," + quoted(point.point.name) + "," + point.point.preset + "," +
             quoted(joined(point.point.set)) + "," + std::to_string(point.runs) + "," +
             digits(point.cost_ms) + "," + digits(point.wall_ms) + "," + digits(point.error) + "," +
             (compared ? digits(compared->interval.low) + "," + digits(compared->interval.high) +
                             "," + digits(compared->p)
                       : ",,") +
             "," + name_of(scene.limit) + "," +
             quoted(largest_of(point) ? largest_of(point)->name : "") + "," +
             (point.on_front ? "1" : "0") + "," + digits(point.over_front) + "," +
             quoted(point.failed);
      for (const std::string& name : names) {
        const FigureError* error = find_error(point, name);
        csv += "," + (error ? digits(error->error) : std::string());
      }
      csv += "\n";
    }
  }
  return csv;
}

std::string trade_json(const Trade& trade) {
  Figures figures = {{"/runs", static_cast<std::int64_t>(trade.runs)}};
  if (trade.missing.empty()) figures["/missing"] = EmptyList{};
  for (std::size_t i = 0; i < trade.missing.size(); ++i) {
    figures["/missing/" + std::to_string(i)] = trade.missing[i];
  }
  for (std::size_t i = 0; i < trade.scenes.size(); ++i) {
    const std::string at = "/scenes/" + std::to_string(i);
    figures[at + "/scene"] = trade.scenes[i].scene;
    figures[at + "/limit"] = name_of(trade.scenes[i].limit);
    const std::vector<PointTrade>& points = trade.scenes[i].points;
    for (std::size_t j = 0; j < points.size(); ++j) {
      put(figures, at + "/points/" + std::to_string(j), points[j]);
    }
  }
  return format_figures(figures);
}

std::string trade_table(const Trade& trade) {
  std::string text =
      "scene              point      ms per frame   error   90 % interval      p  cost/front  "
      "largest error\n";
  for (const SceneTrade& scene : trade.scenes) {
    for (const PointTrade& point : scene.points) {
      char line[200];
      const FigureError* largest = largest_of(point);
      const std::string last = !point.failed.empty() ? point.failed
                               : largest             ? format_difference(*largest)
                                                     : std::string();
      const std::string interval = point.compared
                                       ? decimals(point.compared->interval.low) + " to " +
                                             decimals(point.compared->interval.high)
                                       : std::string();
      std::snprintf(line, sizeof line, "%-18s %-10s %12.3f %7s %15s %6s %11s  %s\n",
                    scene.scene.c_str(), point.point.name.c_str(), point.cost_ms,
                    point.error ? decimals(*point.error).c_str() : "", interval.c_str(),
                    point.compared ? digits(point.compared->p, 2).c_str() : "",
                    digits(point.over_front, 3).c_str(), last.c_str());
      text += line;
    }
    text += scene.scene + ": limit " + name_of(scene.limit) + "\n";
  }
  return text;
}

}  // namespace sunder::scenes
