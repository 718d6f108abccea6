// HTML page of a timing.
#include <algorithm>
#include <numeric>

#include "engine/model/work.h"
#include "scenes/report/page.h"
#include "scenes/report/plot.h"
#include "scenes/timing/stalls.h"
#include "scenes/timing/timing_report.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kBins = 12;

/// Returns the milliseconds of every frame: their sum first, then one curve per stage.
std::vector<Curve> frames_of(const Figures& scene, const std::string& clock) {
  std::vector<Curve> curves = {{"frame", {}}};
  for (const char* stage : kStageNames) curves.push_back({stage, {}});
  for (int i = 0;; ++i) {
    const std::string at = "/per_frame/" + std::to_string(i) + "/" + clock + "/";
    if (!scene.contains(at + kStageNames[0])) return curves;
    const double time_s = (i + 1) / 60.0;
    double sum_ms = 0;
    for (std::size_t stage = 0; stage < kStages; ++stage) {
      const double ms = number_at(scene, at + kStageNames[stage]);
      curves[stage + 1].points.push_back({time_s, ms});
      sum_ms += ms;
    }
    curves[0].points.push_back({time_s, sum_ms});
  }
}

std::string histogram(const Curve& frames) {
  double most = 1e-9;
  for (const PlotPoint& frame : frames.points) most = std::max(most, frame.y);
  const double width = most / kBins;
  std::vector<Bar> bars;
  for (std::size_t i = 0; i < kBins; ++i) {
    bars.push_back({"to " + rounded(width * static_cast<double>(i + 1)), 0});
  }
  for (const PlotPoint& frame : frames.points) {
    ++bars[std::min(kBins - 1, static_cast<std::size_t>(frame.y / width))].value;
  }
  return svg_bars({"", {"processor ms per frame"}, {"frames"}}, bars);
}

std::string stages_table(const Figures& scene) {
  std::vector<std::string> head = {"ms per frame"};
  const bool is_drawn = scene.contains("/draw/every");
  std::vector<std::vector<Cell>> rows(is_drawn ? kStages + 2 : kStages + 1);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string name = row < kStages ? kStageNames[row] : row == kStages ? "frame" : "draw";
    const std::string at = (row < kStages ? "/stages/" : "/") + name + "/";
    rows[row].push_back({name});
    for (const std::string clock : {"cpu_", ""}) {
      for (const std::string figure : {"mean", "p50", "p95", "p99", "max"}) {
        if (row == 0) head.push_back((clock.empty() ? "wall " : "processor ") + figure);
        rows[row].push_back({rounded(number_at(scene, at + clock + figure + "_ms"))});
      }
    }
  }
  return html_table(head, rows);
}

std::string modelled_table(const Figures& scene) {
  std::vector<std::vector<Cell>> rows;
  const std::string head = "/modelled/";
  for (const auto& [place, value] : scene) {
    if (!place.starts_with(head)) continue;
    const std::string feature = place.substr(head.size());
    std::vector<Cell>& row =
        rows.emplace_back(std::vector<Cell>{{feature}, {text_at(scene, place)}, {""}, {""}});
    for (const Saving& saving : savings_of(scene)) {
      if (saving.feature != feature) continue;
      row[2] = {rounded(saving.without_ms)};
      row[3] = {rounded(saving.with_ms - saving.without_ms)};
    }
  }
  return html_table({"feature", "in this scene", "processor ms per frame without it", "saving"},
                    rows);
}

std::string verdicts_table(const std::string& scene, std::span<const Verdict> verdicts) {
  std::vector<std::vector<Cell>> rows;
  for (const Verdict& verdict : verdicts) {
    if (verdict.scene != scene) continue;
    const bool failed = verdict.outcome == Outcome::kFailed;
    const bool passed = verdict.outcome == Outcome::kPassed;
    rows.push_back({{verdict.what},
                    {failed   ? "failed"
                     : passed ? "passed"
                              : "skipped",
                     failed},
                    {verdict.text}});
  }
  return html_table({"check", "", ""}, rows);
}

std::string stalls_list(const Figures& scene) {
  const std::string lines = stall_lines(scene, text_at(scene, "/scene"));
  return lines.empty() ? "" : "<pre>" + escaped(lines) + "</pre>\n";
}

std::string changes_table(const std::string& scene, std::span<const Change> changes) {
  std::vector<std::vector<Cell>> rows;
  for (const Change& change : changes) {
    if (change.scene != scene) continue;
    rows.push_back(
        {{change.what + " " + change.figure},
         {change.unit},
         {rounded(change.before)},
         {rounded(change.now)},
         {change.before > 0 ? rounded(100 * (change.now / change.before - 1)) + " %" : ""}});
  }
  return rows.empty() ? "" : html_table({"figure", "", "before", "now", "change"}, rows);
}

std::string judgements_table(const std::string& scene, const Judgements& judgements) {
  std::vector<std::vector<Cell>> rows;
  for (const Judged& judged : judgements.figures) {
    if (judged.scene != scene) continue;
    rows.push_back({{judged.pair.name()},
                    {judged.pair.unit},
                    {rounded(judged.before)},
                    {rounded(judged.now)},
                    {judged.interval_text()},
                    {name_of(judged.judgement), judged.judgement == Judgement::kSlower}});
  }
  return rows.empty() ? "" : html_table({"figure", "", "before", "now", "change", ""}, rows);
}

std::string section(const Figures& scene, std::span<const Verdict> verdicts,
                    std::span<const Change> changes, const Judgements& judgements) {
  const std::string name = text_at(scene, "/scene");
  const std::vector<Curve> cpu = frames_of(scene, "stages_cpu_ms");
  const std::vector<Curve> wall = frames_of(scene, "stages_ms");
  return "<section>\n<h2>" + escaped(name) + "</h2>\n<p>" + escaped(run_line(scene)) + "<br>" +
         escaped(counts_line(scene)) + "<br>" + escaped(text_at(scene, "/cpu")) + "</p>\n" +
         verdicts_table(name, verdicts) + changes_table(name, changes) +
         judgements_table(name, judgements) + stages_table(scene) + stalls_list(scene) +
         svg_curves({"processor time", {"simulated time, s"}, {"ms per frame"}}, cpu) +
         svg_curves({"wall time", {"simulated time, s"}, {"ms per frame"}}, wall) +
         histogram(cpu[0]) + modelled_table(scene) + "</section>\n";
}

constexpr const char* kIntroduction =
    "<h1>Frame timing</h1>\n"
    "<p>A frame is 1/60 s of simulated time. Mean, p50 and p95 are over the frames, each the "
    "median "
    "of the repeats; p99 and max are over all frames of all repeats. Processor time is summed over "
    "all threads; wall time is elapsed time.</p>\n";

}  // namespace

std::string timing_page(std::span<const Figures> scenes, std::span<const Verdict> verdicts,
                        std::span<const Change> changes, const Judgements& judgements) {
  std::string body = kIntroduction;
  for (const Figures& scene : scenes) body += section(scene, verdicts, changes, judgements);
  return html_page({"Sunder: frame timing", body});
}

}  // namespace sunder::scenes
