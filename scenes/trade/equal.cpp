#include "scenes/trade/equal.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <span>
#include <utility>

#include "engine/base/random.h"
#include "engine/io/figures.h"
#include "scenes/trade/errors.h"
#include "scenes/trade/merge.h"

namespace sunder::scenes {
namespace {

/// Deals runs in random order, and all of them before one again.
class Dealer {
 public:
  explicit Dealer(std::size_t runs) : order_(runs), dealt_(runs) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }
  std::span<const std::size_t> deal(std::size_t count) {
    if (dealt_ + count > order_.size()) {
      dealt_ = 0;
      shuffle(order_, random_);
    }
    dealt_ += count;
    return std::span<const std::size_t>(order_).subspan(dealt_ - count, count);
  }

 private:
  std::vector<std::size_t> order_;
  std::size_t dealt_;
  Random random_{1};
};

EqualPoint compare(const std::string& scene, const PointRuns& point, std::size_t seeds, int pairs) {
  EqualPoint found;
  found.scene = scene;
  found.point = point.point;
  found.runs = static_cast<int>(point.facts.size());
  found.failed = point.failed;
  if (point.facts.size() < 2 * seeds) return found;
  const RunDistances distances(point.facts);
  Dealer dealer(point.facts.size());
  for (found.pairs = 0; found.pairs < pairs; ++found.pairs) {
    const std::span<const std::size_t> runs = dealer.deal(2 * seeds);
    const PointError error = distances.compare(runs.first(seeds), runs.subspan(seeds));
    found.differ += error.differs();
    found.mean_error += error.error / pairs;
    found.largest_error = std::max(found.largest_error, error.error);
  }
  return found;
}

double share(int count, int of) { return of > 0 ? static_cast<double>(count) / of : 0; }

}  // namespace

EqualStudy compare_equal(const std::vector<StudyRun>& runs, const std::filesystem::path& folder,
                         int seeds, int pairs) {
  StudyRuns stored = read_runs(runs, folder);
  EqualStudy study;
  study.seeds = seeds;
  study.runs = runs.size();
  study.missing = std::move(stored.missing);
  for (const SceneRuns& scene : stored.scenes)
    for (const PointRuns& point : scene.points)
      study.points.push_back(compare(scene.scene, point, static_cast<std::size_t>(seeds), pairs));
  return study;
}

std::string equal_json(const EqualStudy& study) {
  Figures figures = {{"/runs", static_cast<std::int64_t>(study.runs)},
                     {"/seeds", std::int64_t{study.seeds}},
                     {"/expected_share", kFalsePositives}};
  if (study.missing.empty()) figures["/missing"] = EmptyList{};
  for (std::size_t i = 0; i < study.missing.size(); ++i)
    figures["/missing/" + std::to_string(i)] = study.missing[i];
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    const EqualPoint& point = study.points[i];
    const std::string at = "/points/" + std::to_string(i);
    figures[at + "/scene"] = point.scene;
    figures[at + "/name"] = point.point.name;
    figures[at + "/runs"] = std::int64_t{point.runs};
    figures[at + "/pairs"] = std::int64_t{point.pairs};
    figures[at + "/differ"] = std::int64_t{point.differ};
    figures[at + "/mean_error"] = point.mean_error;
    figures[at + "/largest_error"] = point.largest_error;
    if (!point.failed.empty()) figures[at + "/failed"] = point.failed;
  }
  return format_figures(figures);
}

std::string equal_table(const EqualStudy& study) {
  std::string text = "scene              point        runs   pairs  differ  mean error  largest\n";
  EqualPoint all;
  const auto add_line = [&](const char* scene, const char* name, const EqualPoint& point) {
    char line[200];
    std::snprintf(line, sizeof line, "%-18s %-10s %6d %7d %5.1f %% %11.3f %8.2f  %s\n", scene, name,
                  point.runs, point.pairs, 100 * share(point.differ, point.pairs), point.mean_error,
                  point.largest_error, point.failed.c_str());
    text += line;
  };
  for (const EqualPoint& point : study.points) {
    add_line(point.scene.c_str(), point.point.name.c_str(), point);
    all.runs += point.runs;
    all.pairs += point.pairs;
    all.differ += point.differ;
    all.mean_error += point.mean_error * point.pairs;
    all.largest_error = std::max(all.largest_error, point.largest_error);
  }
  if (all.pairs > 0) all.mean_error /= all.pairs;
  add_line("all", "", all);
  return text;
}

}  // namespace sunder::scenes
