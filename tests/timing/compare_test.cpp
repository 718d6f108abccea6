// Tests of the comparison of timings with older ones.
#include "scenes/timing/compare.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

/// Returns scene and check of each failed verdict, in order.
std::vector<std::string> failed(const Comparison& comparison) {
  std::vector<std::string> all;
  for (const Verdict& verdict : comparison.verdicts) {
    if (verdict.outcome == Outcome::kFailed) all.push_back(verdict.scene + ", " + verdict.what);
  }
  return all;
}

Comparison compared(const Figures& now, const Figures& old, std::optional<double> fail_slower) {
  return compare(std::span(&now, 1), std::span(&old, 1), "old.json", fail_slower, false);
}

TEST(CompareTimings, ASlowdownOfATenthFailsAtFivePercentAndNotAtFifteen) {
  const Figures old = made_up_timings("house", 1);
  Figures now = old;
  now["/stages/solve/cpu_mean_ms"] = 1.1;
  EXPECT_EQ(failed(compared(now, old, 0.05)), (std::vector<std::string>{"house, stage solve"}));
  EXPECT_TRUE(failed(compared(now, old, 0.15)).empty());
  EXPECT_TRUE(failed(compared(now, old, std::nullopt)).empty())
      << "reported, but without a threshold nothing fails";
  EXPECT_TRUE(failed(compared(old, old, 0.0)).empty());
  EXPECT_TRUE(failed(compared(old, now, 0.0)).empty()) << "faster is fine";

  now = old;
  now["/stages/break/cpu_mean_ms"] = 1.1;
  now["/frame/cpu_mean_ms"] = 7.7;
  EXPECT_EQ(failed(compared(now, old, 0.05)),
            (std::vector<std::string>{"house, stage break", "house, stage frame"}));
}

TEST(CompareTimings, ProcessorTimeDecidesWhereBothHaveIt) {
  const Figures old = made_up_timings("house", 1);
  Figures now = old;
  now["/stages/solve/mean_ms"] = 5.0;
  EXPECT_TRUE(failed(compared(now, old, 0.05)).empty()) << "another program had the processor";
  Figures older = old;
  std::erase_if(older, [](const auto& entry) { return entry.first.ends_with("/cpu_mean_ms"); });
  EXPECT_EQ(failed(compared(now, older, 0.05)), (std::vector<std::string>{"house, stage solve"}));
  const auto changes = compared(now, older, 0.05).changes;
  EXPECT_TRUE(std::ranges::any_of(
      changes, [](const Change& c) { return c.stage == "solve" && !c.is_cpu && c.after_ms == 5; }));
  std::erase_if(older, [](const auto& entry) { return entry.first.ends_with("mean_ms"); });
  now["/stages/load/cpu_p50_ms"] = 5.0;
  EXPECT_EQ(failed(compared(now, older, 0.05)), (std::vector<std::string>{"house, stage load"}))
      << "without means, medians of frames are compared";
}

TEST(CompareTimings, NoiseOfShortStagesDoesNotFail) {
  Figures old = made_up_timings("house", 0.05);
  Figures now = made_up_timings("house", 0.05);
  now["/stages/act/cpu_mean_ms"] = 0.19;
  EXPECT_TRUE(failed(compared(now, old, 0.05)).empty())
      << "nearly four times as long, but too short to measure";
  now["/stages/act/cpu_mean_ms"] = 0.25;
  EXPECT_EQ(failed(compared(now, old, 0.05)), (std::vector<std::string>{"house, stage act"}))
      << "long enough to measure";
}

TEST(CompareTimings, AStageWithoutAnOlderTimeFails) {
  Figures old = made_up_timings("house", 1);
  std::erase_if(old, [](const auto& entry) { return entry.first.starts_with("/stages/load/"); });
  EXPECT_EQ(failed(compared(made_up_timings("house", 1), old, std::nullopt)),
            (std::vector<std::string>{"house, stage load"}));
}

TEST(CompareTimings, ASceneThatTheOlderFileLacksIsReportedAndFails) {
  const Figures now[] = {made_up_timings("house", 1), made_up_timings("glass", 1)},
                old[] = {made_up_timings("house", 1)};
  const Comparison comparison = compare(now, old, "old.json", std::nullopt, false);
  EXPECT_EQ(failed(comparison), (std::vector<std::string>{"glass, same run"}));
  EXPECT_NE(comparison.verdicts.back().text.find("not in old.json"), std::string::npos);
}

TEST(CompareTimings, RunsWithDifferentSettingsAreNotCompared) {
  const Figures old = made_up_timings("house", 1);
  Figures draft = old;
  draft["/preset"] = std::string("draft");
  EXPECT_EQ(failed(compared(draft, old, 0.05)), (std::vector<std::string>{"house, same run"}));
  EXPECT_TRUE(compared(draft, old, 0.05).changes.empty());
  for (const char* place : {"/frames", "/threads"}) {
    Figures now = old;
    now[place] = std::int64_t{7};
    EXPECT_EQ(failed(compared(now, old, 0.05)), (std::vector<std::string>{"house, same run"}));
  }
}

TEST(CompareTimings, TimesOfADifferentStateAreShownAndOnlyTheStateFails) {
  const Figures old = made_up_timings("house", 1);
  Figures now = made_up_timings("house", 2);
  now["/state_hash"] = std::string("0123456789abcdee");
  const Comparison comparison = compared(now, old, 0.05);
  EXPECT_EQ(failed(comparison), (std::vector<std::string>{"house, same run"}));
  EXPECT_EQ(comparison.changes.size(), kStages + 1);
  EXPECT_NE(changes_table(comparison.changes).find("+100.0 %"), std::string::npos);
}

/// Sets the mean times of the repeats of the solve stage.
void put_repeats(Figures& scene, std::initializer_list<double> means_ms) {
  int i = 0;
  for (const double mean_ms : means_ms)
    scene["/repeat_ms/solve/processor/" + std::to_string(i++)] = mean_ms;
}

TEST(CompareTimings, ASlowdownWithinTheSpreadOfRepeatsDoesNotFail) {
  Figures old = made_up_timings("house", 1), now = old;
  now["/stages/solve/cpu_mean_ms"] = 1.1;
  put_repeats(old, {1, 1.2, 0.9, 1.1, 1});
  put_repeats(now, {1.1, 0.9, 1.3, 1.15, 1});
  EXPECT_TRUE(failed(compared(now, old, 0.05)).empty())
      << "the slowdown is within the spread of repeats";
  put_repeats(old, {1, 1.01, 0.99, 1, 1});
  put_repeats(now, {1.1, 1.11, 1.09, 1.1, 1.1});
  EXPECT_EQ(failed(compared(now, old, 0.05)), (std::vector<std::string>{"house, stage solve"}));
  EXPECT_TRUE(failed(compared(now, old, 0.10)).empty())
      << "the lower end of the interval is less than a tenth";
  const std::string table = changes_table(compared(now, old, 0.05).changes);
  EXPECT_NE(table.find("% (97 % confidence)  slower"), std::string::npos) << table;
}

TEST(CompareTimings, RepeatsTimedInTurnsAreComparedInPairs) {
  Figures old = made_up_timings("house", 1), now = old;
  now["/stages/solve/cpu_mean_ms"] = 1.1;
  put_repeats(old, {1, 2, 3, 4, 5, 6});
  put_repeats(now, {1.1, 2.2, 3.3, 4.4, 5.5, 6.6});
  EXPECT_TRUE(failed(compared(now, old, 0.05)).empty());
  EXPECT_EQ(failed(compare(std::span(&now, 1), std::span(&old, 1), "other", 0.05, true)),
            (std::vector<std::string>{"house, stage solve"}));
}

TEST(CompareTimings, PercentagesAreReadAndNothingElse) {
  EXPECT_DOUBLE_EQ(parse_percent("--fail-slower", "10%"), 0.1);
  EXPECT_DOUBLE_EQ(parse_percent("--fail-slower", "2.5"), 0.025);
  EXPECT_DOUBLE_EQ(parse_percent("--fail-slower", "0%"), 0);
  for (const char* wrong : {"", "%", "ten", "10%%", "-5%", "inf", "nan", "1 0"}) {
    EXPECT_THROW(parse_percent("--fail-slower", wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace sunder::scenes
