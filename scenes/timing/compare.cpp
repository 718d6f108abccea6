#include "scenes/timing/compare.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/printed.h"
#include "engine/model/work.h"
#include "scenes/report/page.h"

namespace sunder::scenes {
namespace {

/// Values that must be equal in both runs, if the older file has them.
constexpr const char* kRunKeys[] = {
    "/preset", "/frames", "/dt_s", "/substeps", "/solver/max_colors", "/solver/sweeps", "/threads"};

const Figures* find_scene(std::span<const Figures> scenes, const std::string& name) {
  const auto found = std::ranges::find_if(
      scenes, [&](const Figures& scene) { return text_at(scene, "/scene") == name; });
  return found == scenes.end() ? nullptr : &*found;
}

std::string figure_text(const Figures& figures, const std::string& place) {
  const std::string text = text_at(figures, place);
  return text.empty() ? rounded(number_at(figures, place), 6) : text;
}

/// Returns the reason why the runs cannot be compared; empty if they can.
std::string incomparable_reason(const Figures& now, const Figures& old,
                                const std::string& old_file) {
  for (const std::string place : kRunKeys) {
    if (!old.contains(place)) continue;  // file of an older version
    const std::string after = figure_text(now, place), before = figure_text(old, place);
    if (after == before) continue;
    return "not comparable: " + place.substr(1) + " is " + before + " in " + old_file + " and " +
           after + " now; run with the same settings";
  }
  return {};
}

/// Checks that two comparable runs have the same state.
Verdict check_same_state(const Figures& now, const Figures& old, const std::string& old_file) {
  Verdict verdict{text_at(now, "/scene"), "same run", Outcome::kPassed, {}};
  const std::string after = text_at(now, "/state_hash"), before = text_at(old, "/state_hash");
  if (after != before) {
    verdict.outcome = Outcome::kFailed;
    verdict.text = "the state differs: " + before + " in " + old_file + ", " + after + " now" +
                   "; the motion has changed, so that times cannot be compared";
    return verdict;
  }
  const std::string cpu = text_at(old, "/cpu");
  verdict.text = "same state as in " + old_file;
  if (cpu != text_at(now, "/cpu")) verdict.text += ", which was timed on another processor: " + cpu;
  return verdict;
}

/// Returns the stage's means by repeat; the time at `place` if there are none.
std::vector<double> repeats_of(const Figures& scene, const Change& change,
                               const std::string& place) {
  const std::string at = "/repeat_ms/" + change.stage + (change.is_cpu ? "/processor/" : "/wall/");
  std::vector<double> means;
  while (scene.contains(at + std::to_string(means.size())))
    means.push_back(number_at(scene, at + std::to_string(means.size())));
  if (means.empty() || change.figure != "mean") return {number_at(scene, place)};
  return means;
}

/// Returns the change of a stage in a time that both runs have: processor time before wall time,
/// and the mean before the median, which can jump if frames are partly idle.
std::optional<Change> change_of(const std::string& stage, const std::string& at, const Figures& now,
                                const Figures& old, bool paired) {
  for (const std::string figure : {"mean", "p50"}) {
    for (const bool is_cpu : {true, false}) {
      const std::string place = at + (is_cpu ? "cpu_" : "") + figure + "_ms";
      if (!now.contains(place) || !old.contains(place)) continue;
      Change change{text_at(now, "/scene"), stage, figure, is_cpu, number_at(old, place),
                    number_at(now, place),  {}};
      change.ratio =
          ratio_interval(repeats_of(now, change, place), repeats_of(old, change, place), paired);
      return change;
    }
  }
  return std::nullopt;
}

std::string describe(const Change& change) {
  return change.figure + " " + rounded(change.before_ms) + " ms of " +
         (change.is_cpu ? "processor" : "wall") + " time before, " + rounded(change.after_ms) +
         " ms now; change " + change.interval();
}

Verdict check_stage(const Change& change, std::optional<double> fail_slower) {
  const bool fails = fail_slower && change.is_slower(*fail_slower);
  std::string text = describe(change);
  if (fails) text += ", slower by more than " + rounded(100 * *fail_slower) + " %";
  return {change.scene, "stage " + change.stage, fails ? Outcome::kFailed : Outcome::kPassed, text};
}

void compare_stages(const Figures& now, const Figures& old, std::optional<double> fail_slower,
                    bool paired, bool same_state, Comparison& comparison) {
  const auto add = [&](const std::string& stage, const std::string& at) {
    const std::optional<Change> change = change_of(stage, at, now, old, paired);
    if (change && !same_state) {
      comparison.changes.push_back(*change);
      return;
    }
    if (!change) {
      comparison.verdicts.push_back({text_at(now, "/scene"), "stage " + stage, Outcome::kFailed,
                                     "the older file has no time of this stage"});
      return;
    }
    comparison.verdicts.push_back(check_stage(*change, fail_slower));
    comparison.changes.push_back(*change);
  };
  for (const std::string stage : kStageNames) add(stage, "/stages/" + stage + "/");
  add("frame", "/frame/");
}

}  // namespace

double parse_percent(const std::string& flag, const std::string& text) {
  double percent = 0;
  const std::string digits = text.ends_with('%') ? text.substr(0, text.size() - 1) : text;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, percent);
  if (error != std::errc() || stop != end || !(percent >= 0) || !std::isfinite(percent)) {
    throw InputError(flag + " " + text + ": expected a percentage of at least 0, such as 10%");
  }
  return percent / 100;
}

bool Change::is_slower(double part) const {
  return std::min(after_ms, ratio.low * before_ms) > (1 + part) * std::max(before_ms, kNoise_ms);
}

std::string Change::interval() const {
  if (!(ratio.confidence > 0)) return "one run each, no interval";
  return printed("%+.1f to %+.1f %% (%.0f %% confidence)", 100 * (ratio.low - 1),
                 100 * (ratio.high - 1), 100 * ratio.confidence);
}

Comparison compare(std::span<const Figures> now, std::span<const Figures> old,
                   const std::string& old_file, std::optional<double> fail_slower, bool paired) {
  Comparison comparison;
  for (const Figures& scene : now) {
    const std::string name = text_at(scene, "/scene");
    const Figures* before = find_scene(old, name);
    const std::string why =
        before ? incomparable_reason(scene, *before, old_file)
               : "not in " + old_file + "; time this scene with the older program, too";
    if (!why.empty()) {
      comparison.verdicts.push_back({name, "same run", Outcome::kFailed, why});
      continue;
    }
    comparison.verdicts.push_back(check_same_state(scene, *before, old_file));
    const bool same_state = comparison.verdicts.back().outcome == Outcome::kPassed;
    compare_stages(scene, *before, fail_slower, paired, same_state, comparison);
  }
  return comparison;
}

std::string changes_table(std::span<const Change> changes) {
  if (changes.empty()) return {};
  std::string text =
      "scene          stage      ms per frame     before       now   change  interval\n";
  for (const Change& change : changes) {
    const double part = change.before_ms > 0 ? change.after_ms / change.before_ms - 1 : 0;
    text +=
        printed("%-14s %-10s %-4s %-9s %9.3f %9.3f %+7.1f %%  ", change.scene.c_str(),
                change.stage.c_str(), change.figure.c_str(), change.is_cpu ? "processor" : "wall",
                change.before_ms, change.after_ms, 100 * part);
    text += change.interval() + (change.is_slower(0) ? "  slower\n" : "\n");
  }
  return text;
}

}  // namespace sunder::scenes
