// Plots and HTML page of a study.
#include <algorithm>

#include "scenes/report/page.h"
#include "scenes/report/plot.h"
#include "scenes/trade/report.h"

namespace sunder::scenes {
namespace {

// Presets with a larger cost relative to the front are highlighted.
constexpr double kMaxCostRatio = 1.1;

std::string format_number(const std::optional<double>& value) {
  return value ? rounded(*value) : "";
}

std::string interval_of(const PointTrade& point) {
  if (!point.compared) return {};
  const Interval& interval = point.compared->interval;
  return format_number(interval.low) + " to " + format_number(interval.high);
}

std::string options_of(const StudyPoint& point) {
  std::string text = "--preset " + point.preset;
  for (const std::string& assignment : point.set) text += " --set " + assignment;
  return text;
}

bool exceeds_cost_ratio(const PointTrade& point) {
  return point.point.is_preset() && point.over_front && *point.over_front > kMaxCostRatio;
}

PlotPoint plotted(const PointTrade& point) {
  return {point.cost_ms, point.counted_error(), point.point.name,
          point.point.name + ": " + format_number(point.cost_ms) + " ms, error " +
              format_number(point.error)};
}

/// Returns a table of each preset's cost relative to the front, by scene.
std::string presets_table(const Trade& trade) {
  std::vector<std::string> head = {"cost / front"};
  std::vector<std::vector<Cell>> rows;
  for (const SceneTrade& scene : trade.scenes) {
    std::vector<Cell>& row = rows.emplace_back(std::vector<Cell>{{scene.scene}});
    for (const PointTrade& point : scene.points) {
      if (!point.point.is_preset()) continue;
      auto column = static_cast<std::size_t>(
          std::find(head.begin() + 1, head.end(), point.point.name) - head.begin());
      if (column == head.size()) head.push_back(point.point.name);
      if (row.size() <= column) row.resize(column + 1);
      row[column] = {point.failed.empty() ? format_number(point.over_front) : "failed",
                     exceeds_cost_ratio(point) || !point.failed.empty(), point.failed};
    }
  }
  return html_table(head, rows);
}

std::string points_table(const SceneTrade& scene) {
  std::vector<std::vector<Cell>> rows;
  for (const PointTrade& point : scene.points) {
    rows.push_back({{point.point.name, false, options_of(point.point)},
                    {format_number(point.cost_ms)},
                    {format_number(point.wall_ms)},
                    {format_number(point.error), !point.failed.empty(), point.failed},
                    {interval_of(point)},
                    {point.compared ? format_number(point.compared->p) : "",
                     point.compared && point.compared->differs()},
                    {point.on_front ? "on the front" : format_number(point.over_front),
                     exceeds_cost_ratio(point)},
                    {std::to_string(point.runs)}});
  }
  return html_table({"point", "processor ms per frame", "wall ms", "error", "90 % interval", "p",
                     "cost / front", "runs"},
                    rows);
}

/// Returns a table with a column per figure; those that differ from the limit are highlighted.
std::string errors_table(const SceneTrade& scene) {
  std::vector<std::string> head = {"error"};
  for (const PointTrade& point : scene.points) {
    if (!point.compared) continue;
    for (const FigureError& error : point.compared->figures) {
      if (std::find(head.begin() + 1, head.end(), error.name) == head.end()) {
        head.push_back(error.name);
      }
    }
  }
  std::vector<std::vector<Cell>> rows;
  for (const PointTrade& point : scene.points) {
    if (!point.compared) continue;
    std::vector<Cell>& row = rows.emplace_back(std::vector<Cell>(head.size()));
    row[0] = {point.point.name};
    for (const FigureError& error : point.compared->figures) {
      const auto column = std::find(head.begin() + 1, head.end(), error.name) - head.begin();
      row[static_cast<std::size_t>(column)] = {format_number(error.error), error.differs(),
                                               format_number(error.difference) + " / " +
                                                   format_number(error.spread) + ", p " +
                                                   format_number(error.p)};
    }
  }
  return rows.empty() ? "" : html_table(head, rows);
}

std::string list(const std::string& what, const std::vector<std::string>& entries) {
  if (entries.empty()) return {};
  std::string html = "<p>" + escaped(what) + "</p>\n<ul>\n";
  for (const std::string& entry : entries) html += "<li>" + escaped(entry) + "</li>\n";
  return html + "</ul>\n";
}

std::string section(const SceneTrade& scene) {
  std::vector<std::string> failed;
  for (const PointTrade& point : scene.points) {
    if (!point.failed.empty()) failed.push_back(point.point.name + ", " + point.failed);
  }
  return "<section>\n<h2>" + escaped(scene.scene) + "</h2>\n<p>Limit: " + name_of(scene.limit) +
         "</p>\n" + trade_svg(scene) + points_table(scene) + errors_table(scene) +
         list("Runs that failed:", failed) + "</section>\n";
}

constexpr const char* kIntroduction =
    "<h1>What accuracy costs</h1>\n"
    "<p>Every scene is run at every point with several seeds, which also shift its steps. The "
    "<b>error</b> of a point is the mean distance between a run of it and a run of the limit, less "
    "the mean distance between two runs of equal settings, in units of the latter at the limit, "
    "averaged over all figures: 0 for a point that equals the limit. <b>p</b> is the probability "
    "of such a difference between equal settings; one of at most 0.05, highlighted, tells the "
    "point from the limit, and those of single figures are corrected for their number. The limit "
    "<b>converged</b> if it has an error of at most 0.25 with steps of twice the length. The "
    "<b>cost</b> is the processor time of a frame, the median over seeds. Points on the "
    "<b>front</b> are beaten by no other in both error and cost. Move the pointer over a cell for "
    "details.</p>\n";

}  // namespace

std::string trade_svg(const SceneTrade& scene) {
  Curve front{"front", {}, true, false}, presets{"presets", {}, false, true},
      others{"other points", {}, false, true};
  for (const PointTrade& point : scene.points) {
    if (!point.error) continue;
    (point.point.is_preset() ? presets : others).points.push_back(plotted(point));
    if (point.on_front) front.points.push_back({point.cost_ms, point.counted_error()});
  }
  std::sort(front.points.begin(), front.points.end(),
            [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  const Curve curves[] = {front, presets, others};
  return svg_curves({scene.scene, {"processor ms per frame", true}, {"error", true}}, curves);
}

std::string trade_html(const Trade& trade) {
  std::string body = kIntroduction + presets_table(trade);
  for (const SceneTrade& scene : trade.scenes) body += section(scene);
  body += list("Runs that are missing:", trade.missing);
  return html_page({"Sunder: what accuracy costs", body});
}

}  // namespace sunder::scenes
