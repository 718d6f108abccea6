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

const TradeError* find_error(const PointTrade& point, const std::string& name) {
  const auto at = std::find_if(point.errors.begin(), point.errors.end(),
                               [&](const TradeError& error) { return error.name == name; });
  return at == point.errors.end() ? nullptr : &*at;
}

/// Returns the largest error of a point over its noise; null if it has none.
const TradeError* worst_of(const PointTrade& point) {
  const auto at = std::max_element(
      point.errors.begin(), point.errors.end(),
      [](const TradeError& a, const TradeError& b) { return a.over_noise < b.over_noise; });
  return at == point.errors.end() ? nullptr : &*at;
}

/// Returns "drift 0.012 m": the name of an error ends with its unit, or is one, as "pieces".
std::string format_distance(const TradeError& error) {
  const std::size_t space = error.name.rfind(' ');
  const std::string distance = digits(error.distance, 3);
  if (space == std::string::npos) return distance + " " + error.name;
  return error.name.substr(0, space) + " " + distance + error.name.substr(space);
}

/// Returns the names of all errors of all scenes.
std::set<std::string> error_names(const std::vector<SceneTrade>& scenes) {
  std::set<std::string> names;
  for (const SceneTrade& scene : scenes) {
    for (const PointTrade& point : scene.points) {
      for (const TradeError& error : point.errors) names.insert(error.name);
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
  for (std::size_t i = 0; i < point.errors.size(); ++i) {
    const TradeError& error = point.errors[i];
    const std::string place = at + "/errors/" + std::to_string(i);
    figures[place + "/name"] = error.name;
    put(figures, place + "/distance", error.distance);
    put(figures, place + "/noise", error.noise);
    put(figures, place + "/over_noise", error.over_noise);
  }
}

}  // namespace

std::string trade_csv(const Trade& trade) {
  const std::set<std::string> names = error_names(trade.scenes);
  std::string csv =
      "scene,point,preset,set,runs,cost_ms,wall_ms,error,worst,on_front,over_front,failed";
  for (const std::string& name : names) csv += "," + quoted(name);
  csv += "\n";
  for (const SceneTrade& scene : trade.scenes) {
    for (const PointTrade& point : scene.points) {
      csv += quoted(scene.scene) + "," + quoted(point.point.name) + "," + point.point.preset + "," +
             quoted(joined(point.point.set)) + "," + std::to_string(point.runs) + "," +
             digits(point.cost_ms) + "," + digits(point.wall_ms) + "," + digits(point.error) + "," +
             quoted(worst_of(point) ? worst_of(point)->name : "") + "," +
             (point.on_front ? "1" : "0") + "," + digits(point.over_front) + "," +
             quoted(point.failed);
      for (const std::string& name : names) {
        const TradeError* error = find_error(point, name);
        csv += "," + (error ? digits(error->over_noise) : std::string());
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
    const std::vector<PointTrade>& points = trade.scenes[i].points;
    for (std::size_t j = 0; j < points.size(); ++j) {
      put(figures, at + "/points/" + std::to_string(j), points[j]);
    }
  }
  return format_figures(figures);
}

std::string trade_table(const Trade& trade) {
  std::string text =
      "scene              point      ms per frame  error/noise  cost/front  largest error\n";
  for (const SceneTrade& scene : trade.scenes) {
    for (const PointTrade& point : scene.points) {
      char line[200];
      const TradeError* worst = worst_of(point);
      const std::string last = !point.failed.empty() ? point.failed
                               : worst               ? format_distance(*worst)
                                                     : std::string();
      std::snprintf(line, sizeof line, "%-18s %-10s %12.3f %12s %11s  %s\n", scene.scene.c_str(),
                    point.point.name.c_str(), point.cost_ms, digits(point.error, 3).c_str(),
                    digits(point.over_front, 3).c_str(), last.c_str());
      text += line;
    }
  }
  return text;
}

}  // namespace sunder::scenes
