#include "scenes/timing/compare.h"

#include <algorithm>

#include "engine/base/printed.h"
#include "engine/model/work.h"
#include "scenes/report/page.h"

namespace sunder::scenes {
namespace {

/// Values that must be equal in both runs, if both files have them: they say what was simulated.
constexpr const char* kRunKeys[] = {
    "/preset", "/frames", "/dt_s", "/substeps", "/solver/max_colors", "/solver/sweeps"};
/// Values without which times cannot be compared: they say on what, and how, the run was timed.
constexpr const char* kMachineKeys[] = {"/threads",
                                        "/cpu",
                                        "/machine/governor",
                                        "/machine/processors",
                                        "/machine/omp_proc_bind",
                                        "/machine/omp_places",
                                        "/at_once",
                                        "/draw/every",
                                        "/draw/renderer"};
/// Values that are named if they differ, as one may want to compare them.
constexpr const char* kNamedKeys[] = {
    "/commit",     "/build/compiler",   "/build/flags",          "/build/processor",
    "/build/type", "/build/sanitizers", "/machine/instructions", "/machine/kernel"};

const Figures* find_scene(std::span<const Figures> scenes, const std::string& name) {
  const auto found = std::ranges::find_if(
      scenes, [&](const Figures& scene) { return text_at(scene, "/scene") == name; });
  return found == scenes.end() ? nullptr : &*found;
}

std::string figure_text(const Figures& figures, const std::string& place) {
  const auto found = figures.find(place);
  const bool is_text = std::holds_alternative<std::string>(found->second);
  return is_text ? text_at(figures, place) : rounded(number_at(figures, place), 6);
}

/// Returns "KEY is A in OLD and B now" for each value that both have and that differs.
std::vector<std::string> differences(std::span<const char* const> keys, const Figures& now,
                                     const Figures& old, const std::string& old_file) {
  std::vector<std::string> texts;
  for (const std::string place : keys) {
    if (!old.contains(place) || !now.contains(place)) continue;  // file of an older version
    const std::string after = figure_text(now, place), before = figure_text(old, place);
    if (after == before) continue;
    texts.push_back(place.substr(1) + " is " + before + " in " + old_file + " and " + after +
                    " now");
  }
  return texts;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

/// Checks that two runs of the same settings have the same state.
Verdict check_same_state(const Figures& now, const Figures& old, const std::string& old_file) {
  const std::string after = text_at(now, "/state_hash"), before = text_at(old, "/state_hash");
  Verdict verdict{text_at(now, "/scene"), "same run", Outcome::kPassed, {}};
  if (after == before) {
    const std::string named = joined(differences(kNamedKeys, now, old, old_file));
    verdict.text = "same state as in " + old_file + (named.empty() ? "" : "; " + named);
    return verdict;
  }
  verdict.outcome = Outcome::kFailed;
  verdict.text = "the state differs: " + before + " in " + old_file + ", " + after + " now" +
                 "; the motion has changed, so that times cannot be compared";
  return verdict;
}

std::vector<Change> changes_of(const Figures& now, const Figures& old) {
  std::vector<Change> changes;
  const auto add = [&](const std::string& what, const std::string& figure, const std::string& unit,
                       const std::string& place) {
    if (!now.contains(place) || !old.contains(place)) return;
    changes.push_back(
        {text_at(now, "/scene"), what, figure, unit, number_at(old, place), number_at(now, place)});
  };
  const auto add_times = [&](const std::string& what, const std::string& figure,
                             const std::string& at) {
    add(what, figure, "ms of processor time", at + "cpu_" + figure + "_ms");
    add(what, figure, "ms of wall time", at + figure + "_ms");
  };
  for (const std::string stage : kStageNames) add_times(stage, "mean", "/stages/" + stage + "/");
  for (const std::string figure : {"mean", "p50", "p95", "p99", "max"})
    add_times("frame", figure, "/frame/");
  add("memory", "peak", "MB", "/memory_MB");
  add_times("draw", "mean", "/draw/");
  return changes;
}

}  // namespace

Comparison compare(std::span<const Figures> now, std::span<const Figures> old,
                   const std::string& old_file) {
  Comparison comparison;
  const auto fail = [&](const std::string& scene, const std::string& what,
                        const std::string& text) {
    comparison.verdicts.push_back({scene, what, Outcome::kFailed, text});
  };
  for (const Figures& scene : now) {
    const std::string name = text_at(scene, "/scene");
    const Figures* before = find_scene(old, name);
    if (!before) {
      fail(name, "same run",
           "not in " + old_file + "; time this scene with the older program, too");
      continue;
    }
    if (const auto texts = differences(kRunKeys, scene, *before, old_file); !texts.empty()) {
      fail(name, "same run", "not comparable: " + joined(texts) + "; run with the same settings");
      continue;
    }
    comparison.verdicts.push_back(check_same_state(scene, *before, old_file));
    if (const auto texts = differences(kMachineKeys, scene, *before, old_file); !texts.empty()) {
      fail(name, "same machine",
           "times are not comparable: " + joined(texts) + "; time both in the same way");
      continue;
    }
    const std::vector<Change> changes = changes_of(scene, *before);
    comparison.changes.insert(comparison.changes.end(), changes.begin(), changes.end());
  }
  return comparison;
}

std::string changes_table(std::span<const Change> changes) {
  if (changes.empty()) return {};
  std::string text =
      "scene          figure          unit                     before       now   change\n";
  for (const Change& change : changes) {
    text += printed("%-14s %-15s %-20s %10.4g %9.4g", change.scene.c_str(),
                    (change.what + " " + change.figure).c_str(), change.unit.c_str(), change.before,
                    change.now);
    text += change.before > 0 ? printed(" %+7.1f %%\n", 100 * (change.now / change.before - 1))
                              : "        -\n";
  }
  return text;
}

}  // namespace sunder::scenes
