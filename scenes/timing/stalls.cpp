#include "scenes/timing/stalls.h"

#include <algorithm>

#include "engine/base/printed.h"
#include "engine/io/statistics.h"
#include "engine/model/work.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kMaxWritten = 20, kMaxPrinted = 3;

/// Path of the wall time of a stage of a frame.
std::string place_of(std::size_t frame, const std::string& stage) {
  const std::string at = "/per_frame/" + std::to_string(frame) + "/";
  return at + (stage == "draw" ? "draw_ms" : "stages_ms/" + stage);
}

/// Times of one frame in every repeat: wall time of each stage, and processor time of all.
struct FrameTimes {
  std::vector<std::vector<double>> stage_ms;  ///< By stage, then by repeat.
  std::vector<double> ms, processor_ms;       ///< By repeat.
};

std::vector<std::string> stages_and_draw() {
  std::vector<std::string> names(std::begin(kStageNames), std::end(kStageNames));
  names.emplace_back("draw");
  return names;
}

FrameTimes times_of(std::span<const Figures> runs, std::size_t frame) {
  FrameTimes times;
  times.ms.resize(runs.size());
  times.processor_ms.resize(runs.size());
  const std::string at = "/per_frame/" + std::to_string(frame);
  for (const std::string& stage : stages_and_draw()) {
    std::vector<double>& of_stage = times.stage_ms.emplace_back();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      of_stage.push_back(number_at(runs[i], place_of(frame, stage)));
      times.ms[i] += of_stage.back();
      times.processor_ms[i] += number_at(
          runs[i], stage == "draw" ? at + "/draw_cpu_ms" : at + "/stages_cpu_ms/" + stage);
    }
  }
  return times;
}

void find_in_frame(const FrameTimes& times, int frame, std::vector<Stall>& stalls) {
  const double median_ms = quantile(times.ms, 0.5);
  const std::vector<std::string> names = stages_and_draw();
  for (std::size_t i = 0; i < times.ms.size(); ++i) {
    const double excess_ms = times.ms[i] - median_ms;
    if (excess_ms < std::max(kStall_ms, kStallShare * median_ms)) continue;
    Stall stall{static_cast<int>(i) + 1, frame, times.ms[i], excess_ms, {}};
    stall.processor_excess_ms = times.processor_ms[i] - quantile(times.processor_ms, 0.5);
    for (std::size_t s = 0; s < names.size(); ++s) {
      const double more_ms = times.stage_ms[s][i] - quantile(times.stage_ms[s], 0.5);
      if (more_ms <= stall.stage_excess_ms) continue;
      stall.stage = names[s];
      stall.stage_excess_ms = more_ms;
    }
    stalls.push_back(stall);
  }
}

}  // namespace

std::vector<Stall> find_stalls(std::span<const Figures> runs) {
  std::vector<Stall> stalls;
  if (runs.size() < 2) return stalls;  // no frame has another to be compared with
  for (std::size_t i = 0; runs[0].contains(place_of(i, kStageNames[0])); ++i)
    find_in_frame(times_of(runs, i), static_cast<int>(i) + 1, stalls);
  std::ranges::stable_sort(stalls, std::greater(), &Stall::excess_ms);
  return stalls;
}

std::vector<double> count_stalls(std::span<const Stall> stalls, std::size_t repeats) {
  std::vector<double> counts(repeats);
  for (const Stall& stall : stalls) ++counts[static_cast<std::size_t>(stall.repeat) - 1];
  return counts;
}

void put_stalls(std::span<const Stall> stalls, Figures& scene) {
  scene["/stalls/count"] = static_cast<std::int64_t>(stalls.size());
  for (std::size_t i = 0; i < std::min(stalls.size(), kMaxWritten); ++i) {
    const Stall& stall = stalls[i];
    const std::string at = "/stalls/longest/" + std::to_string(i);
    scene[at + "/repeat"] = std::int64_t{stall.repeat};
    scene[at + "/frame"] = std::int64_t{stall.frame};
    scene[at + "/ms"] = stall.ms;
    scene[at + "/excess_ms"] = stall.excess_ms;
    scene[at + "/stage"] = stall.stage;
    scene[at + "/stage_excess_ms"] = stall.stage_excess_ms;
    scene[at + "/processor_excess_ms"] = stall.processor_excess_ms;
  }
}

std::string stall_lines(const Figures& scene, const std::string& of) {
  std::string text;
  std::size_t printed_stalls = 0;
  for (; printed_stalls < kMaxPrinted; ++printed_stalls) {
    const std::string at = "/stalls/longest/" + std::to_string(printed_stalls);
    if (!scene.contains(at + "/ms")) break;
    text += of + ": stall: frame " +
            printed("%.0f of repeat %.0f took %.1f ms of wall time, %.1f ms more than its median: ",
                    number_at(scene, at + "/frame"), number_at(scene, at + "/repeat"),
                    number_at(scene, at + "/ms"), number_at(scene, at + "/excess_ms")) +
            printed("%.1f ms more in stage ", number_at(scene, at + "/stage_excess_ms")) +
            text_at(scene, at + "/stage") +
            printed(", and %.1f ms more of processor time\n",
                    number_at(scene, at + "/processor_excess_ms"));
  }
  const double others = number_at(scene, "/stalls/count") - static_cast<double>(printed_stalls);
  if (others > 0) text += of + printed(": and %.0f more stalled frames\n", others);
  return text;
}

}  // namespace sunder::scenes
