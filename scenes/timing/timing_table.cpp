// Tables of a timing for the terminal.
#include "engine/base/printed.h"
#include "engine/model/work.h"
#include "scenes/report/page.h"
#include "scenes/timing/timing_report.h"

namespace sunder::scenes {
namespace {

std::string count_of(const Figures& scene, const std::string& place) {
  return std::to_string(static_cast<long long>(number_at(scene, place)));
}

std::string stage_row(const Figures& scene, const std::string& name, const std::string& at) {
  std::string row = printed("  %-10s", name.c_str());
  for (const std::string clock : {"cpu_", ""}) {
    for (const char* figure : {"mean_ms", "p50_ms", "p95_ms", "p99_ms", "max_ms"}) {
      row += printed(" %8.3f", number_at(scene, at + clock + figure));
    }
    if (!clock.empty()) row += "  ";
  }
  return row + "\n";
}

constexpr const char* kHead =
    "             processor ms per frame                         wall ms per frame\n"
    "  stage          mean      p50      p95      p99      max       mean      p50      p95      "
    "p99"
    "      max\n";

}  // namespace

std::string run_line(const Figures& scene) {
  const double threads = number_at(scene, "/threads");
  std::string text = text_at(scene, "/preset") + ", " + count_of(scene, "/frames") + " frames, " +
                     count_of(scene, "/threads") + (threads == 1 ? " thread" : " threads");
  if (scene.contains("/repeats")) {
    text += ", median of " + count_of(scene, "/repeats") + " repeats, spread " +
            rounded(100 * number_at(scene, "/spread"), 2) + " %";
  }
  return text;
}

std::string counts_line(const Figures& scene) {
  return "peak: " + count_of(scene, "/peak/bodies") + " bodies, " + count_of(scene, "/peak/awake") +
         " awake, " + count_of(scene, "/peak/debris") + " debris, " +
         count_of(scene, "/peak/dust") + " dust, " + rounded(number_at(scene, "/memory_MB")) +
         " MB; total: " + count_of(scene, "/fractures/events") + " breaks into " +
         count_of(scene, "/fractures/pieces") + " pieces";
}

std::vector<Saving> savings_of(const Figures& scene) {
  std::vector<Saving> savings;
  const std::string head = "/features/", tail = "/cpu_mean_ms";
  for (const auto& [place, value] : scene) {
    if (!place.starts_with(head) || !place.ends_with(tail)) continue;
    savings.push_back({place.substr(head.size(), place.size() - head.size() - tail.size()),
                       number_at(scene, "/frame/cpu_mean_ms"), number_at(scene, place)});
  }
  return savings;
}

std::string timing_table(std::span<const Figures> scenes) {
  std::string text;
  for (const Figures& scene : scenes) {
    text += text_at(scene, "/scene") + ": " + run_line(scene) + "\n" + kHead;
    for (const std::string stage : kStageNames) {
      text += stage_row(scene, stage, "/stages/" + stage + "/");
    }
    text += stage_row(scene, "frame", "/frame/");
    if (scene.contains("/draw/every")) text += stage_row(scene, "draw", "/draw/");
    text += "  " + counts_line(scene) + "\n";
  }
  return text;
}

std::string features_table(std::span<const Figures> scenes) {
  std::string text;
  for (const Figures& scene : scenes) {
    for (const Saving& saving : savings_of(scene)) {
      const double saved_ms = saving.with_ms - saving.without_ms;
      text += printed("%-14s %-20s %9.3f %9.3f %9.3f %7.1f %%\n", text_at(scene, "/scene").c_str(),
                      saving.feature.c_str(), saving.with_ms, saving.without_ms, saved_ms,
                      saving.with_ms > 0 ? 100 * saved_ms / saving.with_ms : 0);
    }
  }
  if (text.empty()) return text;
  return "processor ms per frame, mean              with   without     saves\n" + text;
}

std::string verdict_lines(std::span<const Verdict> verdicts, bool failed) {
  std::string text;
  for (const Verdict& verdict : verdicts) {
    if ((verdict.outcome == Outcome::kFailed) != failed) continue;
    if (!failed && verdict.what.starts_with(kFigure)) continue;
    text += (failed ? "failed: " : "") + verdict.scene + ", " + verdict.what + ": " + verdict.text +
            "\n";
  }
  return text;
}

}  // namespace sunder::scenes
