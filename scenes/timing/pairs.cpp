#include "scenes/timing/pairs.h"

#include <algorithm>
#include <optional>

#include "engine/model/work.h"
#include "scenes/timing/stalls.h"

namespace sunder::scenes {
namespace {

constexpr const char* kProcessor = "ms of processor time";
constexpr const char* kWall = "ms of wall time";

bool all_contain(std::span<const Figures> runs, const std::string& place) {
  return std::ranges::all_of(runs, [&](const Figures& run) { return run.contains(place); });
}

std::vector<double> values_at(std::span<const Figures> runs, const std::string& place) {
  std::vector<double> values;
  for (const Figures& run : runs) values.push_back(number_at(run, place));
  return values;
}

std::string place_of(std::size_t figure) { return "/against/figures/" + std::to_string(figure); }

std::vector<double> list_at(const Figures& scene, const std::string& place) {
  std::vector<double> values;
  while (scene.contains(place + "/" + std::to_string(values.size())))
    values.push_back(number_at(scene, place + "/" + std::to_string(values.size())));
  return values;
}

}  // namespace

std::string PairedFigure::name() const { return what + " " + figure; }

std::vector<PairedFigure> paired_figures(std::span<const Figures> now,
                                         std::span<const Figures> before) {
  std::vector<PairedFigure> pairs;
  const auto add = [&](const std::string& what, const std::string& figure, const std::string& unit,
                       const std::string& place) {
    if (!all_contain(now, place) || !all_contain(before, place)) return;
    pairs.push_back({what, figure, unit, values_at(now, place), values_at(before, place)});
  };
  const std::string mean = "/frame/cpu_mean_ms";
  const bool is_cpu = all_contain(now, mean) && all_contain(before, mean) &&
                      number_at(now.front(), "/threads") == 1;
  const std::string clock = is_cpu ? "cpu_" : "", unit = is_cpu ? kProcessor : kWall;
  for (const std::string stage : kStageNames)
    add(stage, "mean", unit, "/stages/" + stage + "/" + clock + "mean_ms");
  for (const std::string figure : {"mean", "p50", "p95", "p99", "max"})
    add("frame", figure, unit, "/frame/" + clock + figure + "_ms");
  if (is_cpu) {
    for (const std::string figure : {"p99", "max"})
      add("frame", figure, kWall, "/frame/" + figure + "_ms");
  }
  const std::string first_frame = std::string("/per_frame/0/stages_ms/") + kStageNames[0];
  if (all_contain(now, first_frame) && all_contain(before, first_frame)) {
    pairs.push_back({"frame", "stalls", "frames", count_stalls(find_stalls(now), now.size()),
                     count_stalls(find_stalls(before), before.size())});
  }
  add("memory", "peak", "MB", "/memory_MB");
  if (is_cpu) add("draw", "mean", kProcessor, "/draw/cpu_mean_ms");
  add("draw", "mean", kWall, "/draw/mean_ms");
  return pairs;
}

void put_pairs(std::span<const PairedFigure> pairs, Figures& scene) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string at = place_of(i);
    scene[at + "/what"] = pairs[i].what;
    scene[at + "/figure"] = pairs[i].figure;
    scene[at + "/unit"] = pairs[i].unit;
    for (std::size_t k = 0; k < pairs[i].now.size(); ++k) {
      scene[at + "/now/" + std::to_string(k)] = pairs[i].now[k];
      scene[at + "/before/" + std::to_string(k)] = pairs[i].before[k];
    }
  }
}

std::vector<PairedFigure> pairs_of(const Figures& scene) {
  std::vector<PairedFigure> pairs;
  for (std::string at = place_of(0); scene.contains(at + "/what"); at = place_of(pairs.size())) {
    pairs.push_back({text_at(scene, at + "/what"), text_at(scene, at + "/figure"),
                     text_at(scene, at + "/unit"), list_at(scene, at + "/now"),
                     list_at(scene, at + "/before")});
    const std::size_t repeats = std::min(pairs.back().now.size(), pairs.back().before.size());
    pairs.back().now.resize(repeats);
    pairs.back().before.resize(repeats);
  }
  return pairs;
}

}  // namespace sunder::scenes
