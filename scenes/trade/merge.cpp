#include "scenes/trade/merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/io/statistics.h"
#include "scenes/trade/front.h"
#include "scenes/trade/run_file.h"

namespace sunder::scenes {
namespace {

PointRuns& find_or_add(std::vector<SceneRuns>& scenes, const StudyRun& run) {
  if (scenes.empty() || scenes.back().scene != run.scene) scenes.push_back({run.scene, {}});
  std::vector<PointRuns>& points = scenes.back().points;
  const auto at = std::find_if(points.begin(), points.end(), [&](const PointRuns& found) {
    return found.point.name == run.point.name;
  });
  return at != points.end() ? *at : points.emplace_back(PointRuns{run.point, {}, {}, {}, {}});
}

PointTrade evaluate(const PointRuns& found, std::span<const Facts> limit) {
  PointTrade trade;
  trade.point = found.point;
  trade.runs = static_cast<int>(found.cpu_ms.size());
  trade.cost_ms = quantile(found.cpu_ms, 0.5);
  trade.wall_ms = quantile(found.wall_ms, 0.5);
  trade.failed = found.failed;
  if (limit.size() >= 2 && found.facts.size() >= 2 && !found.point.is_limit()) {
    trade.compared = point_error(found.facts, limit);
    trade.error = trade.compared->error;
  }
  if (!found.failed.empty()) trade.error = std::numeric_limits<double>::infinity();
  return trade;
}

/// Finds the front among the points with a finite error, except the limits, and costs relative to
/// it.
void find_front(std::vector<PointTrade>& trades) {
  std::vector<TradePoint> points;
  std::vector<PointTrade*> trade_at;
  for (PointTrade& trade : trades) {
    if (trade.point.is_limit() || trade.point.is_coarser_limit()) continue;
    if (!trade.error || !std::isfinite(*trade.error)) continue;
    points.push_back(
        {trade.point.name, trade.point.is_preset(), trade.cost_ms, trade.counted_error()});
    trade_at.push_back(&trade);
  }
  for (const std::size_t i : pareto_front(points)) trade_at[i]->on_front = true;
  for (std::size_t i = 0; i < points.size(); ++i) trade_at[i]->over_front = over_front(points, i);
}

Convergence convergence_of(const std::vector<PointTrade>& points) {
  const auto coarser =
      std::ranges::find(points, kLimit2h, [](const PointTrade& each) { return each.point.name; });
  if (coarser == points.end() || !coarser->compared || !coarser->failed.empty())
    return Convergence::kUnknown;
  if (coarser->compared->interval.high <= kConvergedError) return Convergence::kConverged;
  return coarser->compared->differs() ? Convergence::kNoLimit : Convergence::kUndecided;
}

SceneTrade evaluate(const SceneRuns& found) {
  SceneTrade scene;
  scene.scene = found.scene;
  std::span<const Facts> limit;
  for (const PointRuns& point : found.points) {
    if (point.point.is_limit()) limit = point.facts;
  }
  for (const PointRuns& point : found.points) {
    if (!point.cpu_ms.empty()) scene.points.push_back(evaluate(point, limit));
  }
  find_front(scene.points);
  scene.limit = convergence_of(scene.points);
  return scene;
}

}  // namespace

const char* name_of(Convergence convergence) {
  switch (convergence) {
    case Convergence::kUnknown:
      return "unknown";
    case Convergence::kConverged:
      return "converged";
    case Convergence::kNoLimit:
      return "no limit";
    case Convergence::kUndecided:
      return "undecided";
  }
  return "";
}

StudyRuns read_runs(const std::vector<StudyRun>& runs, const std::filesystem::path& folder) {
  StudyRuns study;
  for (const StudyRun& run : runs) {
    PointRuns& found = find_or_add(study.scenes, run);
    const StoredRun stored = read_run(folder, run);
    if (!stored.missing.empty()) {
      study.missing.push_back(run.name() + (stored.damaged ? " (" + stored.missing + ")" : ""));
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
  return study;
}

Trade merge(const std::vector<StudyRun>& runs, const std::filesystem::path& folder) {
  StudyRuns study = read_runs(runs, folder);
  Trade trade;
  trade.runs = runs.size();
  trade.missing = std::move(study.missing);
  for (const SceneRuns& scene : study.scenes) trade.scenes.push_back(evaluate(scene));
  return trade;
}

double PointTrade::counted_error() const { return std::max(*error, kLeastError); }

}  // namespace sunder::scenes
