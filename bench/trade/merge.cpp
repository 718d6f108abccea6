#include "bench/trade/merge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/trade/front.h"
#include "bench/trade/run_file.h"
#include "engine/io/statistics.h"

namespace sunder::bench {
namespace {

/// The runs of a point on one scene that are there.
struct Found {
  StudyPoint point;
  std::vector<Facts> facts;  ///< Of those that did not fail.
  std::vector<double> cpu_ms, wall_ms;
  std::string failed;
};

struct FoundScene {
  std::string scene;
  std::vector<Found> points;
};

Found& found_at(std::vector<FoundScene>& scenes, const StudyRun& run) {
  if (scenes.empty() || scenes.back().scene != run.scene) scenes.push_back({run.scene, {}});
  std::vector<Found>& points = scenes.back().points;
  const auto at = std::find_if(points.begin(), points.end(), [&](const Found& found) {
    return found.point.name == run.point.name;
  });
  return at != points.end() ? *at : points.emplace_back(Found{run.point, {}, {}, {}, {}});
}

PointTrade trade_of(const Found& found, std::span<const Facts> limit) {
  PointTrade trade;
  trade.point = found.point;
  trade.runs = static_cast<int>(found.cpu_ms.size());
  trade.cost_ms = quantile(found.cpu_ms, 0.5);
  trade.wall_ms = quantile(found.wall_ms, 0.5);
  trade.failed = found.failed;
  if (!limit.empty() && !found.facts.empty() && !found.point.is_limit()) {
    trade.errors = trade_errors(found.facts, limit);
    trade.error = worst(trade.errors);
  }
  if (!found.failed.empty()) trade.error = std::numeric_limits<double>::infinity();
  return trade;
}

/// Only what has an error can be on the front; the limit is what errors are measured from.
void find_front(std::vector<PointTrade>& trades) {
  std::vector<TradePoint> points;
  std::vector<PointTrade*> of_point;
  for (PointTrade& trade : trades) {
    if (trade.point.is_limit() || !trade.error || !std::isfinite(*trade.error)) continue;
    points.push_back({trade.point.name, trade.point.is_preset(), trade.cost_ms, *trade.error});
    of_point.push_back(&trade);
  }
  for (const std::size_t i : pareto_front(points)) of_point[i]->on_front = true;
  for (std::size_t i = 0; i < points.size(); ++i) of_point[i]->over_front = over_front(points, i);
}

SceneTrade trade_of(const FoundScene& found) {
  SceneTrade scene;
  scene.scene = found.scene;
  std::span<const Facts> limit;
  for (const Found& point : found.points) {
    if (point.point.is_limit()) limit = point.facts;
  }
  for (const Found& point : found.points) {
    if (!point.cpu_ms.empty()) scene.points.push_back(trade_of(point, limit));
  }
  find_front(scene.points);
  return scene;
}

}  // namespace

Trade merge(const std::vector<StudyRun>& runs, const std::filesystem::path& folder) {
  Trade trade;
  trade.runs = runs.size();
  std::vector<FoundScene> scenes;
  for (const StudyRun& run : runs) {
    Found& found = found_at(scenes, run);
    const StoredRun stored = read_run(folder, run);
    if (!stored.missing.empty()) {
      trade.missing.push_back(run.name() + (stored.damaged ? " (" + stored.missing + ")" : ""));
      continue;
    }
    const RunResult& result = stored.ran.result;
    found.cpu_ms.push_back(stored.ran.time.cpu_ms);
    found.wall_ms.push_back(stored.ran.time.wall_ms);
    if (result.failed.empty()) {
      found.facts.push_back(result.facts);
    } else if (found.failed.empty()) {
      found.failed = "seed " + std::to_string(run.seed) + ": " + result.failed;
    }
  }
  for (const FoundScene& scene : scenes) trade.scenes.push_back(trade_of(scene));
  return trade;
}

}  // namespace sunder::bench
