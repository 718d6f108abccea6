#include "scenes/timing/timing.h"

#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include "engine/base/check.h"
#include "engine/io/statistics.h"
#include "engine/model/work.h"
#include "scenes/features.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

/// Peak resident memory of this process.
double memory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
}

/// Returns true for values to keep: all except the work items of frames, which reports do not use.
bool is_kept(const std::string& place) {
  return !place.starts_with("/per_frame/") || place.find("/work/") == std::string::npos;
}

double median_at(std::span<const Figures> runs, const std::string& place) {
  std::vector<double> values;
  for (const Figures& run : runs) values.push_back(number_at(run, place));
  return quantile(values, 0.5);
}

/// Returns the largest less the least mean processor time of a frame, divided by the median.
double spread_of(std::span<const Figures> runs) {
  const std::string place = "/frame/cpu_mean_ms";
  const auto less = [&](const Figures& a, const Figures& b) {
    return number_at(a, place) < number_at(b, place);
  };
  const auto [least, largest] = std::ranges::minmax_element(runs, less);
  const double median = median_at(runs, place);
  return median > 0 ? (number_at(*largest, place) - number_at(*least, place)) / median : 0;
}

/// Returns the value at `place` of every frame.
std::vector<double> frame_values(const Figures& scene, const std::string& place) {
  std::vector<double> values;
  for (int i = 0;; ++i) {
    const std::string at = "/per_frame/" + std::to_string(i) + place;
    if (!scene.contains(at)) return values;
    values.push_back(number_at(scene, at));
  }
}

void put_times(const std::string& at, const std::vector<double>& ms, Figures& scene) {
  for (const auto& [figure, q] :
       {std::pair{"p50_ms", 0.5}, {"p95_ms", 0.95}, {"p99_ms", 0.99}, {"max_ms", 1.0}}) {
    scene[at + figure] = quantile(ms, q);
  }
  scene[at + "mean_ms"] =
      std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
}

/// Computes the times of stages and of the frame from those of single frames.
void put_times(Figures& scene) {
  for (const bool is_cpu : {true, false}) {
    const std::string clock = is_cpu ? "cpu_" : "";
    std::vector<double> all_ms;
    for (const std::string stage : kStageNames) {
      const auto ms = frame_values(scene, (is_cpu ? "/stages_cpu_ms/" : "/stages_ms/") + stage);
      if (ms.empty()) break;  // file of an older version
      put_times("/stages/" + stage + "/" + clock, ms, scene);
      all_ms.resize(ms.size());
      std::ranges::transform(all_ms, ms, all_ms.begin(), std::plus());
    }
    if (!all_ms.empty()) put_times("/frame/" + clock, all_ms, scene);
  }
}

/// Adds the mean of every run, by stage and for the frame, in processor and wall time.
void put_repeats(std::span<const Figures> runs, Figures& scene) {
  const auto put = [&](const std::string& stage, const std::string& at) {
    for (const bool is_cpu : {true, false}) {
      const std::string place = at + (is_cpu ? "cpu_mean_ms" : "mean_ms");
      const std::string to = "/repeat_ms/" + stage + (is_cpu ? "/processor/" : "/wall/");
      for (std::size_t i = 0; i < runs.size() && runs[i].contains(place); ++i)
        scene[to + std::to_string(i)] = number_at(runs[i], place);
    }
  };
  for (const std::string stage : kStageNames) put(stage, "/stages/" + stage + "/");
  put("frame", "/frame/");
}

}  // namespace

int last_frame(const Scene& scene) { return static_cast<int>(std::lround(scene.duration_s * 60)); }

Scene load_scene(const TimedRun& run) {
  Scene scene = load_scene(run.scene, run.load);
  if (const Feature* feature = find_feature(run.without)) feature->turn_off(scene);
  return scene;
}

Figures time_run(const TimedRun& run, bool warn) {
  Scene scene = load_scene(run);
  const int end = last_frame(scene);
  const int last = std::min(run.frames, end), state_frames = std::min(kStateFrames, end);
  Statistics statistics(run_info(scene, run.load.preset));
  StateHash states;
  SimulationOptions options;
  options.warn = [warn](const std::string& warning) {
    if (warn) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  };
  const auto simulation = make_simulation(std::move(scene), options);
  for (int i = 0; i <= last; ++i) {
    const FramePtr frame = simulation->next();
    statistics.take(frame);
    states.take(frame);
  }
  Figures figures = parse_figures(statistics.json(states.hex(), true), run.scene);
  std::erase_if(figures, [](const auto& entry) { return !is_kept(entry.first); });
  for (std::size_t i = 0; i < run.load.set.size(); ++i) {
    figures["/set/" + std::to_string(i)] = run.load.set[i];
  }
  figures["/memory_MB"] = memory_MB();
  if (last < state_frames) return figures;
  figures["/state/frames"] = std::int64_t{state_frames};
  figures["/state/hash"] = states.hex(static_cast<std::size_t>(state_frames) + 1);
  return figures;
}

Figures median_of(std::span<const Figures> runs) {
  SUNDER_CHECK(!runs.empty());
  Figures median = runs.front();
  for (auto& [place, value] : median) {
    if (auto* whole = std::get_if<std::int64_t>(&value)) {
      *whole = std::llround(median_at(runs, place));
    } else if (auto* real = std::get_if<double>(&value)) {
      *real = median_at(runs, place);
    }
  }
  put_times(median);
  put_repeats(runs, median);
  median["/repeats"] = static_cast<std::int64_t>(runs.size());
  median["/spread"] = spread_of(runs);
  median["/differs"] = std::ranges::any_of(runs, [&](const Figures& run) {
    return text_at(run, "/state_hash") != text_at(median, "/state_hash");
  });
  return median;
}

Figures document_of(std::span<const Figures> scenes) {
  Figures document;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const std::string at = "/scenes/" + std::to_string(i);
    for (const auto& [place, value] : scenes[i]) document[at + place] = value;
  }
  return document;
}

std::vector<Figures> scenes_of(const Figures& document, const std::string& file) {
  std::vector<Figures> scenes;
  if (document.contains("/scene")) return {document};
  for (const auto& [place, value] : document) {
    constexpr std::string_view kScenes = "/scenes/";
    const std::size_t end = place.find('/', kScenes.size());
    if (!place.starts_with(kScenes) || end == std::string::npos) continue;
    std::size_t number = document.size();
    std::from_chars(place.data() + kScenes.size(), place.data() + end, number);
    if (number >= document.size()) break;
    scenes.resize(std::max(scenes.size(), number + 1));
    scenes[number][place.substr(end)] = value;
  }
  const bool named = std::ranges::all_of(
      scenes, [](const Figures& scene) { return !text_at(scene, "/scene").empty(); });
  if (scenes.empty() || !named) {
    throw InputError(
        file +
        ": has no timings; give a file of `sunder bench --json` or `sunder simulate --json`");
  }
  return scenes;
}

}  // namespace sunder::scenes
