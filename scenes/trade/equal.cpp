#include "scenes/trade/equal.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <span>

#include "engine/base/random.h"
#include "engine/io/figures.h"
#include "scenes/trade/errors.h"
#include "scenes/trade/merge.h"

namespace sunder::scenes {
namespace {

/// Runs of a point on one scene that did not fail.
struct Pool {
  EqualPoint found;
  std::vector<Facts> facts;
};

Pool& find_or_add(std::vector<Pool>& pools, const StudyRun& run) {
  const auto at = std::ranges::find_if(pools, [&](const Pool& pool) {
    return pool.found.scene == run.scene && pool.found.point.name == run.point.name;
  });
  if (at != pools.end()) return *at;
  Pool& added = pools.emplace_back();
  added.found.scene = run.scene;
  added.found.point = run.point;
  return added;
}

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

void compare(Pool& pool, std::size_t seeds, int pairs) {
  EqualPoint& found = pool.found;
  found.runs = static_cast<int>(pool.facts.size());
  if (pool.facts.size() < 2 * seeds) return;
  const RunDistances distances(pool.facts);
  Dealer dealer(pool.facts.size());
  for (found.pairs = 0; found.pairs < pairs; ++found.pairs) {
    const std::span<const std::size_t> runs = dealer.deal(2 * seeds);
    const PointError error = distances.compare(runs.first(seeds), runs.subspan(seeds));
    found.differ += error.differs();
    found.mean_error += error.error / pairs;
    found.largest_error = std::max(found.largest_error, error.error);
  }
}

double share(int count, int of) { return of > 0 ? static_cast<double>(count) / of : 0; }

}  // namespace

EqualStudy compare_equal(const std::vector<StudyRun>& runs, const std::filesystem::path& folder,
                         int seeds, int pairs) {
  EqualStudy study;
  study.seeds = seeds;
  study.runs = runs.size();
  std::vector<Pool> pools;
  for (const StudyRun& run : runs) {
    Pool& pool = find_or_add(pools, run);
    const StoredRun stored = read_or_list(run, folder, study.missing);
    if (!stored.missing.empty()) continue;
    const RunResult& result = stored.ran.result;
    if (result.failed.empty()) {
      pool.facts.push_back(result.facts);
    } else if (pool.found.failed.empty()) {
      pool.found.failed = "seed " + std::to_string(run.seed) + ": " + result.failed;
    }
  }
  for (Pool& pool : pools) {
    compare(pool, static_cast<std::size_t>(seeds), pairs);
    study.points.push_back(std::move(pool.found));
  }
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
