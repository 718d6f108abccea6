// sunder bench: frame timing of the benchmark scenes, gated by the state hash: a faster run that
// simulates something else is no faster run.
#include <algorithm>
#include <cstdio>

#include "engine/base/check.h"
#include "engine/io/figures.h"
#include "engine/io/statistics.h"
#include "scenes/app/bench_report.h"
#include "scenes/app/run.h"
#include "scenes/file/text_file.h"

namespace sunder::app {
namespace {

constexpr const char* kQuantiles[] = {"p50_ms", "p95_ms", "p99_ms", "max_ms"};

/// The figures of one scene's run, without the leading place, and its times frame by frame.
Figures measure(const std::string& name, const BenchOptions& options, TimedScene& timed) {
  Scene scene = scenes::load_scene(name, options.load);
  // Scenes are timed beside each other: a shorter one to its end.
  const int end = last_frame(scene, -1);
  const int last = options.frames < 0 ? end : std::min(options.frames, end);
  Statistics statistics(scenes::run_info(scene, options.load.preset));
  Progress progress("bench " + scene.name, last, options.quiet);
  StateHash hash;
  StageTimes times;
  timed.name = scene.name;
  const auto simulation = make_simulation(std::move(scene));
  FramesUntil frames(*simulation, last);
  FrameSink* const sinks[] = {&statistics, &hash, &times, &progress};
  pump(frames, sinks);
  timed.frames = times.frames();
  return parse_figures(statistics.json(hash.hex(), false), name);
}

/// Where a document of scenes holds the one of this name; empty if it does not.
std::string place_of(const Figures& figures, const std::string& scene) {
  for (int i = 0;; ++i) {
    const std::string at = "/scenes/" + std::to_string(i);
    if (!figures.contains(at + "/scene")) return {};
    if (text_at(figures, at + "/scene") == scene) return at;
  }
}

std::string row(const Figures& figures, const std::string& at) {
  char line[200];
  std::snprintf(line, sizeof line, "%-14s %6.0f frames %9.2f %9.2f %9.2f %9.2f  %s\n",
                text_at(figures, at + "/scene").c_str(), number_at(figures, at + "/frames"),
                number_at(figures, at + "/frame/p50_ms"), number_at(figures, at + "/frame/p95_ms"),
                number_at(figures, at + "/frame/p99_ms"), number_at(figures, at + "/frame/max_ms"),
                text_at(figures, at + "/state_hash").c_str());
  return line;
}

/// Ratios old to new, and whether both simulated the same.
struct Comparison {
  std::string line;
  bool same = true;
};

Comparison compare(const Figures& now, const std::string& at, const Figures& old) {
  const std::string scene = text_at(now, at + "/scene");
  const std::string was = place_of(old, scene);
  if (was.empty()) return {scene + ": not in the older file\n"};
  for (const char* key :
       {"/preset", "/frames", "/dt_s", "/substeps", "/solver/max_colors", "/solver/sweeps"}) {
    if (!old.contains(was + key)) continue;  // older than the figure
    if (text_at(now, at + key) != text_at(old, was + key) ||
        number_at(now, at + key) != number_at(old, was + key)) {
      return {scene + ": not comparable, its " + (key + 1) + " differs\n", false};
    }
  }
  std::string line = scene + ": new / old";
  for (const char* quantile : kQuantiles) {
    const double before = number_at(old, was + "/frame/" + quantile);
    const double after = number_at(now, at + "/frame/" + quantile);
    char part[64];
    std::snprintf(part, sizeof part, "  %.3s %.2f", quantile, before > 0 ? after / before : 0);
    line += part;
  }
  const bool same = text_at(now, at + "/state_hash") == text_at(old, was + "/state_hash");
  return {line + (same ? "  same state\n" : "  OTHER STATE: it simulated something else\n"), same};
}

}  // namespace

int bench(const BenchOptions& options) {
  options.apply();
  Figures old;
  if (!options.compare.empty()) {
    old = parse_figures(scenes::read_text(options.compare), options.compare);
    if (!old.contains("/scenes/0/scene")) {
      throw InputError(options.compare + ": not a file of sunder bench --json");
    }
  }
  Figures all;
  std::string table = "scene                  ms a frame:   p50       p95       p99       max\n";
  std::string comparison;
  bool same = true;
  std::vector<TimedScene> timed(options.scenes.size());
  for (std::size_t i = 0; i < options.scenes.size(); ++i) {
    const std::string at = "/scenes/" + std::to_string(i);
    for (const auto& [place, value] : measure(options.scenes[i], options, timed[i])) {
      all[at + place] = value;
    }
    table += row(all, at);
    if (!options.compare.empty()) {
      const Comparison compared = compare(all, at, old);
      comparison += compared.line;
      same = same && compared.same;
    }
  }
  options.say(table + comparison);
  options.write_json(format_figures(all));
  if (!options.page.empty()) write_text(options.page, bench_page(timed));
  if (!same) std::fprintf(stderr, "failed: the state differs from %s\n", options.compare.c_str());
  return same ? 0 : 1;
}

}  // namespace sunder::app
