// Tests of the comparison of two files of timings.
#include "scenes/timing/compare.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scenes/timing/timing.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;
using Names = std::vector<std::string>;

/// Returns scene and check of each failed verdict, in order.
Names failed(const Comparison& comparison) {
  Names all;
  for (const Verdict& verdict : comparison.verdicts) {
    if (verdict.outcome == Outcome::kFailed) all.push_back(verdict.scene + ", " + verdict.what);
  }
  return all;
}

Comparison compared(const Figures& now, const Figures& old) {
  return compare(std::span(&now, 1), std::span(&old, 1), "old.json");
}

TEST(CompareTimings, SlowerTimesAreShownAndNotJudged) {
  const Figures old = made_up_timings("house", 1);
  Figures now = made_up_timings("house", 10);
  now["/memory_MB"] = 110.0;
  const Comparison comparison = compared(now, old);
  EXPECT_TRUE(failed(comparison).empty());
  const std::string table = changes_table(comparison.changes);
  EXPECT_NE(table.find("+900.0 %"), std::string::npos) << table;
  EXPECT_EQ(table.find("slower"), std::string::npos) << table;
  EXPECT_EQ(table.find("memory"), std::string::npos) << "the older file has none";
}

TEST(CompareTimings, ASceneThatTheOlderFileLacksIsReportedAndFails) {
  const Figures now[] = {made_up_timings("house", 1), made_up_timings("glass", 1)},
                old[] = {made_up_timings("house", 1)};
  const Comparison comparison = compare(now, old, "old.json");
  EXPECT_EQ(failed(comparison), Names{"glass, same run"});
  EXPECT_NE(comparison.verdicts.back().text.find("not in old.json"), std::string::npos);
}

TEST(CompareTimings, RunsWithDifferentSettingsAreNotCompared) {
  const Figures old = made_up_timings("house", 1);
  Figures draft = old;
  draft["/preset"] = std::string("draft");
  EXPECT_EQ(failed(compared(draft, old)), Names{"house, same run"});
  EXPECT_TRUE(compared(draft, old).changes.empty());
  Figures shorter = old;
  shorter["/frames"] = std::int64_t{7};
  EXPECT_EQ(failed(compared(shorter, old)), Names{"house, same run"});
}

TEST(CompareTimings, TimesOfOtherMachinesThreadsAndPinningAreRefusedWithTheReason) {
  Figures old = made_up_timings("house", 1);
  old["/machine/governor"] = std::string("performance");
  old["/machine/processors"] = std::string("0-3");
  old["/machine/omp_proc_bind"] = std::string("not set");
  old["/at_once"] = std::int64_t{1};
  for (const auto& [place, value] : Figures{{"/threads", std::int64_t{2}},
                                            {"/cpu", std::string("another processor")},
                                            {"/machine/governor", std::string("powersave")},
                                            {"/machine/processors", std::string("0")},
                                            {"/machine/omp_proc_bind", std::string("true")},
                                            {"/at_once", std::int64_t{2}}}) {
    Figures now = old;
    now[place] = value;
    const Comparison comparison = compared(now, old);
    EXPECT_EQ(failed(comparison), Names{"house, same machine"}) << place;
    EXPECT_TRUE(comparison.changes.empty()) << place;
    EXPECT_NE(comparison.verdicts.back().text.find(place.substr(1) + " is "), std::string::npos);
    now["/state_hash"] = std::string("0123456789abcdee");
    EXPECT_EQ(failed(compared(now, old)), (Names{"house, same run", "house, same machine"}))
        << "states are the same on all machines";
  }
}

TEST(CompareTimings, AFileOfAnOlderVersionThatKnowsLessIsCompared) {
  const Figures old = made_up_timings("house", 1);
  Figures now = old;
  now["/machine/governor"] = std::string("performance");
  now["/at_once"] = std::int64_t{2};
  EXPECT_TRUE(failed(compared(now, old)).empty());
  EXPECT_TRUE(failed(compared(old, now)).empty());
}

TEST(CompareTimings, AnotherCommitAndCompilerAreNamedAndCompared) {
  Figures old = made_up_timings("house", 1);
  old["/commit"] = std::string("0123456789ab");
  old["/build/compiler"] = std::string("GNU 12.2.0");
  Figures now = old;
  now["/commit"] = std::string("0123456789ab+changes");
  now["/build/compiler"] = std::string("Clang 14.0.6");
  const Comparison comparison = compared(now, old);
  EXPECT_TRUE(failed(comparison).empty());
  ASSERT_EQ(comparison.verdicts.size(), 1u);
  EXPECT_EQ(comparison.verdicts[0].text,
            "same state as in old.json; commit is 0123456789ab in old.json and "
            "0123456789ab+changes now; build/compiler is GNU 12.2.0 in old.json and Clang 14.0.6 "
            "now");
}

TEST(CompareTimings, TimesOfADifferentStateAreShownAndOnlyTheStateFails) {
  const Figures old = made_up_timings("house", 1);
  Figures now = made_up_timings("house", 2);
  now["/state_hash"] = std::string("0123456789abcdee");
  const Comparison comparison = compared(now, old);
  EXPECT_EQ(failed(comparison), Names{"house, same run"});
  EXPECT_NE(changes_table(comparison.changes).find("+100.0 %"), std::string::npos);
}

}  // namespace
}  // namespace sunder::scenes
