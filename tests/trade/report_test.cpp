// Tests of reports: they list finished, missing and failed runs, and are well-formed in every case.
#include "scenes/trade/report.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/io/figures.h"
#include "scenes/trade/equal.h"
#include "scenes/trade/run_file.h"
#include "tests/engine/markup.h"
#include "tests/scenes/program.h"

namespace sunder::scenes {
namespace {

using tests::Folder;
using tests::markup_mistake;

Study small_study() {
  Study study;
  study.scenes = {"stack"};
  study.points =
      parse_points("draft draft\nrealtime realtime\nfine realtime solver.sweeps=4\n", "");
  study.seeds = 2;
  return study;
}

/// Returns a run at this distance from the limit and of this cost. The name of its quantity has a
/// comma, quotes and a tag, which reports have to escape.
Ran ran_of(double distance, double cost_ms) {
  Ran ran;
  ran.result.facts.samples = {{"drift, <b>\"largest\"</b> m", {1 + distance}}, {"pieces", {4}}};
  ran.result.facts.state_hash = "0";
  ran.time = {cost_ms, 2 * cost_ms, 10};
  return ran;
}

Ran ran_at(const std::string& point, int seed) {
  if (point == "draft") return ran_of(0.5, seed);
  if (point == "realtime") return ran_of(0.2, 4 + seed);
  if (point == "fine") return ran_of(0.3, 20);  // dearer and worse
  return ran_of(0, 100);
}

void write_all(const Folder& folder, const std::vector<StudyRun>& runs) {
  for (const StudyRun& run : runs) {
    write_run(folder.path(), run, ran_at(run.point.name, run.seed));
  }
}

/// Returns the records of a CSV file (RFC 4180).
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& field = records.back().back();
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      field += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      records.back().emplace_back();
    } else if (!quoted && c == '\n') {
      records.emplace_back(1);
    } else {
      field += c;
    }
  }
  EXPECT_FALSE(quoted);
  EXPECT_EQ(records.back(), std::vector<std::string>(1)) << "the last line ends";
  records.pop_back();
  return records;
}

void expect_well_formed(const Trade& trade) {
  EXPECT_EQ(markup_mistake(trade_html(trade)), "");
  for (const SceneTrade& scene : trade.scenes) EXPECT_EQ(markup_mistake(trade_svg(scene)), "");
  const auto records = parse_csv(trade_csv(trade));
  for (const auto& record : records) EXPECT_EQ(record.size(), records[0].size());
  parse_figures(trade_json(trade), "trade.json");
}

const PointTrade& at(const Trade& trade, const std::string& name) {
  for (const PointTrade& point : trade.scenes.at(0).points) {
    if (point.point.name == name) return point;
  }
  throw std::out_of_range(name);
}

TEST(Merge, CostIsTheMedianOverSeedsAndErrorTheMeanOverFigures) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  const Trade trade = merge(runs, folder.path());
  EXPECT_EQ(trade.runs, 8u);
  EXPECT_TRUE(trade.missing.empty());
  ASSERT_EQ(trade.scenes.size(), 1u);
  EXPECT_EQ(at(trade, "realtime").cost_ms, 5);
  EXPECT_EQ(at(trade, "realtime").wall_ms, 10);
  EXPECT_EQ(at(trade, "realtime").runs, 2);
  ASSERT_EQ(at(trade, "realtime").compared->figures.size(), 2u);
  EXPECT_NEAR(*at(trade, "realtime").error, 10, 1e-9) << "0.2 m over 1 %, and equal pieces";
  EXPECT_EQ(at(trade, "realtime").compared->largest()->name, "drift, <b>\"largest\"</b> m");
  EXPECT_GT(*at(trade, "draft").error, *at(trade, "realtime").error);
  EXPECT_TRUE(at(trade, "draft").on_front);
  EXPECT_TRUE(at(trade, "realtime").on_front);
  EXPECT_FALSE(at(trade, "fine").on_front);
  EXPECT_GT(*at(trade, "fine").over_front, 4) << "a cheaper point is better";
  EXPECT_FALSE(at(trade, "limit").error.has_value());
  expect_well_formed(trade);
}

TEST(Merge, MissingRunsAreNamedAndTheRestIsReported) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  std::filesystem::remove(folder / "runs/stack/realtime-2.json");
  std::filesystem::remove(folder / "runs/stack/fine-1.json");
  std::filesystem::remove(folder / "runs/stack/fine-2.json");
  std::filesystem::resize_file(folder / "runs/stack/draft-2.json", 9);
  const Trade trade = merge(runs, folder.path());
  ASSERT_EQ(trade.missing.size(), 4u);
  EXPECT_EQ(trade.missing[0], "stack/fine-1");
  EXPECT_EQ(trade.missing[1].substr(0, 15), "stack/draft-2 (");
  EXPECT_EQ(trade.scenes[0].points.size(), 3u) << "fine has no run";
  EXPECT_EQ(at(trade, "realtime").runs, 1);
  EXPECT_NE(trade_html(trade).find("<li>stack/fine-1</li>"), std::string::npos);
  EXPECT_NE(trade_json(trade).find("\"stack/fine-1\""), std::string::npos);
  expect_well_formed(trade);
}

TEST(Merge, AStudyWithoutAnyRunIsReported) {
  const Folder folder;
  const Trade trade = merge(study_runs(small_study()), folder.path());
  EXPECT_EQ(trade.missing.size(), 8u);
  expect_well_formed(trade);
}

TEST(Merge, WithoutTheLimitThereAreNoErrors) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  for (const char* seed : {"1", "2"}) {
    std::filesystem::remove(folder / ("runs/stack/limit-" + std::string(seed) + ".json"));
  }
  const Trade trade = merge(runs, folder.path());
  EXPECT_FALSE(at(trade, "draft").error.has_value());
  EXPECT_EQ(at(trade, "draft").cost_ms, 1);
  expect_well_formed(trade);
}

TEST(Merge, OneSeedHasNoError) {
  const Folder folder;
  Study study = small_study();
  study.seeds = 1;
  const auto runs = study_runs(study);
  write_all(folder, runs);
  const Trade trade = merge(runs, folder.path());
  EXPECT_FALSE(at(trade, "draft").error.has_value());
  EXPECT_EQ(at(trade, "draft").cost_ms, 1);
  expect_well_formed(trade);
}

/// Returns the verdict on a limit of these two values by seed, which with twice the step is off by
/// `off`. Values of equal settings are 0.1 m apart, on average.
Convergence convergence_at(double off, int seeds) {
  const Folder folder;
  Study study = small_study();
  study.seeds = seeds;
  add_coarser_limits(study.points, study.set);
  const auto runs = study_runs(study);
  for (const StudyRun& run : runs) {
    const double scatter = 0.3 * (run.seed * 37 % seeds) / seeds;
    const bool coarser = run.point.name == kLimit2h;
    write_run(folder.path(), run,
              ran_of(run.point.is_limit() ? scatter : scatter + coarser * off, 1));
  }
  const Trade trade = merge(runs, folder.path());
  EXPECT_FALSE(at(trade, kLimit2h).on_front) << "it is no choice";
  expect_well_formed(trade);
  return trade.scenes.at(0).limit;
}

TEST(Merge, ALimitConvergedIfItIsTheSameWithTwiceTheStep) {
  EXPECT_EQ(convergence_at(0, 16), Convergence::kConverged);
  EXPECT_EQ(convergence_at(0.3, 16), Convergence::kNoLimit);
  EXPECT_EQ(convergence_at(0.15, 3), Convergence::kUndecided) << "three seeds prove nothing";
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  EXPECT_EQ(merge(runs, folder.path()).scenes.at(0).limit, Convergence::kUnknown);
}

TEST(Merge, ErrorsBelowTheNoiseAreNoAdvantageOnTheFront) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  for (const StudyRun& run : runs) {
    const std::string& point = run.point.name;
    const double off = point == "draft" ? 0.0009 : point == "realtime" ? 0.0001 : 0;
    write_run(folder.path(), run, ran_of(off, point == "draft" ? 1 : 5));
  }
  const Trade trade = merge(runs, folder.path());
  EXPECT_GT(*at(trade, "draft").error, *at(trade, "realtime").error);
  EXPECT_TRUE(at(trade, "draft").on_front);
  EXPECT_FALSE(at(trade, "realtime").on_front);
}

TEST(Merge, AFailedPointHasAnInfiniteError) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  Ran failed;
  failed.result.failed = "out of <hand>, \"really\"";
  write_run(folder.path(), runs.front(), failed);
  const Trade trade = merge(runs, folder.path());
  EXPECT_TRUE(trade.missing.empty()) << "a failure is a result";
  EXPECT_EQ(at(trade, "draft").failed, "seed 1: out of <hand>, \"really\"");
  EXPECT_TRUE(std::isinf(*at(trade, "draft").error));
  EXPECT_FALSE(at(trade, "draft").on_front);
  EXPECT_FALSE(at(trade, "draft").over_front.has_value());
  EXPECT_TRUE(at(trade, "realtime").on_front);
  EXPECT_NE(trade_html(trade).find("seed 1: out of &lt;hand>"), std::string::npos);
  expect_well_formed(trade);
}

TEST(Report, CsvHasOneColumnPerError) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  const auto records = parse_csv(trade_csv(merge(runs, folder.path())));
  ASSERT_EQ(records.size(), 5u);
  const std::vector<std::string> first(records[0].begin(), records[0].begin() + 3);
  EXPECT_EQ(first, (std::vector<std::string>{"scene", "point", "preset"}));
  EXPECT_EQ(records[0][16], "drift, <b>\"largest\"</b> m");
  EXPECT_EQ(records[0][17], "pieces");
  EXPECT_EQ(records[1][17], "0") << "as many pieces as the limit has";
  EXPECT_EQ(records[3][3], "solver.sweeps=4");
  EXPECT_EQ(records[4][7], "") << "the limit has no error";
}

TEST(Report, TheTableHasTheUnitsOfItsFigures) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  const std::string table = trade_table(merge(runs, folder.path()));
  EXPECT_NE(table.find("ms per frame   error   90 % interval      p  cost/front  largest error\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("drift, <b>\"largest\"</b> 0.5 m\n"), std::string::npos) << table;
}

TEST(Report, JsonHasTheFiguresOfTheStudy) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  const Figures figures = parse_figures(trade_json(merge(runs, folder.path())), "trade.json");
  EXPECT_EQ(std::get<std::string>(figures.at("/scenes/0/points/1/name")), "realtime");
  EXPECT_EQ(std::get<double>(figures.at("/scenes/0/points/1/cost_ms")), 5);
  EXPECT_EQ(std::get<bool>(figures.at("/scenes/0/points/2/on_front")), false);
  EXPECT_EQ(std::get<std::string>(figures.at("/scenes/0/limit")), "unknown");
  for (const char* key : {"difference", "spread", "error", "p"})
    EXPECT_TRUE(figures.contains(std::string("/scenes/0/points/1/errors/0/") + key)) << key;
  for (const char* key : {"error", "error_low", "error_high", "p", "differs"})
    EXPECT_TRUE(figures.contains(std::string("/scenes/0/points/1/") + key)) << key;
  EXPECT_FALSE(figures.contains("/scenes/0/points/3/error"));
  EXPECT_EQ(std::get<std::int64_t>(figures.at("/runs")), 8);
}

TEST(Equal, GroupsOfOnePointAreComparedWithoutReuseOfRuns) {
  const Folder folder;
  Study study = small_study();
  study.points = {{"realtime", "realtime", {}}};
  study.seeds = 16;
  const auto runs = study_runs(study);
  for (const StudyRun& run : runs)  // half of the runs are far off, but not by their settings
    write_run(folder.path(), run, ran_of(run.seed % 2, 1));
  std::filesystem::remove(folder / "runs/stack/realtime-16.json");
  const EqualStudy found = compare_equal(runs, folder.path(), 7, 300);
  ASSERT_EQ(found.points.size(), 1u);
  EXPECT_EQ(found.missing, std::vector<std::string>{"stack/realtime-16"});
  EXPECT_EQ(found.points[0].runs, 15);
  EXPECT_EQ(found.points[0].pairs, 300);
  EXPECT_LE(found.points[0].differ, 0.07 * 300);
  EXPECT_GT(found.points[0].largest_error, 0);
  const Figures figures = parse_figures(equal_json(found), "equal.json");
  EXPECT_EQ(std::get<std::int64_t>(figures.at("/points/0/pairs")), 300);
  EXPECT_EQ(compare_equal(runs, folder.path(), 8, 300).points[0].pairs, 0) << "15 runs are too few";
}

TEST(Equal, DifferencesOfGroupsAreCounted) {
  const Folder folder;
  Study study = small_study();
  study.points = {{"realtime", "realtime", {}}};
  study.seeds = 400;
  const auto runs = study_runs(study);
  for (const StudyRun& run : runs)
    write_run(folder.path(), run,
              ran_of(Random(static_cast<std::uint64_t>(run.seed)).uniform(), 1));
  const EqualPoint all = compare_equal(runs, folder.path(), 8, 25).points.at(0);
  EXPECT_NEAR(all.mean_error, 0, 0.05);
  const EqualPoint many = compare_equal(runs, folder.path(), 8, 1000).points.at(0);
  EXPECT_NEAR(many.differ / 1000.0, kFalsePositives, 0.02);
}

TEST(Report, ThePageLoadsNoOtherFile) {
  const Folder folder;
  const auto runs = study_runs(small_study());
  write_all(folder, runs);
  const std::string page = trade_html(merge(runs, folder.path()));
  EXPECT_EQ(page.find("src="), std::string::npos);
  EXPECT_EQ(page.find("href="), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace sunder::scenes
