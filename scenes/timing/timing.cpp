#include "scenes/timing/timing.h"

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
#include "scenes/timing/stalls.h"

namespace sunder::scenes {
namespace {

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

/// Appends the value at `place` of every frame that has one.
void append_frame_values(const Figures& run, const std::string& place,
                         std::vector<double>& values) {
  const std::size_t frames = static_cast<std::size_t>(number_at(run, "/frames"));
  for (std::size_t i = 0; i < frames; ++i) {
    const auto found = run.find("/per_frame/" + std::to_string(i) + place);
    if (found != run.end()) values.push_back(number_at(run, found->first));
  }
}

/// Times of every frame: of the medians over the repeats, and of all repeats one after the other.
struct FrameTimes {
  std::vector<double> typical_ms, all_ms;

  void operator+=(const FrameTimes& other) {
    typical_ms.resize(other.typical_ms.size());
    all_ms.resize(other.all_ms.size());
    std::ranges::transform(typical_ms, other.typical_ms, typical_ms.begin(), std::plus());
    std::ranges::transform(all_ms, other.all_ms, all_ms.begin(), std::plus());
  }
};

FrameTimes frame_times(std::span<const Figures> runs, const Figures& median,
                       const std::string& place) {
  FrameTimes times;
  append_frame_values(median, place, times.typical_ms);
  for (const Figures& run : runs) append_frame_values(run, place, times.all_ms);
  return times;
}

/// Writes mean, p50 and p95 of typical frames, and p99 and the largest time of all frames: medians
/// hide what is slow in one repeat only.
void put_times(const std::string& at, const FrameTimes& times, Figures& scene) {
  if (times.typical_ms.empty()) return;  // file of an older version, or no pictures
  scene[at + "p50_ms"] = quantile(times.typical_ms, 0.5);
  scene[at + "p95_ms"] = quantile(times.typical_ms, 0.95);
  scene[at + "p99_ms"] = quantile(times.all_ms, 0.99);
  scene[at + "max_ms"] = quantile(times.all_ms, 1);
  scene[at + "mean_ms"] = std::accumulate(times.typical_ms.begin(), times.typical_ms.end(), 0.0) /
                          static_cast<double>(times.typical_ms.size());
}

/// Computes the times of stages, of the frame and of drawing from those of single frames.
void put_times(std::span<const Figures> runs, Figures& median) {
  for (const bool is_cpu : {true, false}) {
    const std::string clock = is_cpu ? "cpu_" : "";
    FrameTimes frame;
    for (const std::string stage : kStageNames) {
      const FrameTimes times =
          frame_times(runs, median, (is_cpu ? "/stages_cpu_ms/" : "/stages_ms/") + stage);
      put_times("/stages/" + stage + "/" + clock, times, median);
      frame += times;
    }
    put_times("/frame/" + clock, frame, median);
    put_times("/draw/" + clock, frame_times(runs, median, is_cpu ? "/draw_cpu_ms" : "/draw_ms"),
              median);
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

void keep_for_reports(Figures& run) {
  std::erase_if(run, [](const auto& entry) { return !is_kept(entry.first); });
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
  put_times(runs, median);
  put_repeats(runs, median);
  put_stalls(find_stalls(runs), median);
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
