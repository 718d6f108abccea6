// Tests of the judgement of two programs that were timed in pairs.
#include "scenes/timing/judge.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

/// Repeats of a scene whose stages take a millisecond, with the figures that each run has.
std::vector<Figures> repeats(std::size_t count) {
  std::vector<Figures> runs;
  for (std::size_t i = 0; i < count; ++i) {
    runs.push_back(made_up_timings("house", 1, 40));
    for (const std::string clock : {"", "cpu_"}) {
      for (const std::string figure : {"p95_ms", "p99_ms", "max_ms"})
        runs.back()["/frame/" + clock + figure] = 7.0;
    }
    runs.back()["/memory_MB"] = 100.0;
  }
  return runs;
}

/// Multiplies a figure of every run.
void multiply(std::vector<Figures>& runs, const std::string& place, double factor) {
  for (Figures& run : runs) run[place] = factor * number_at(run, place);
}

Judgements judged(const std::vector<Figures>& now, const std::vector<Figures>& before,
                  const std::string& fail_slower = "") {
  const ScenePairs scene = {"house", paired_figures(now, before)};
  const auto bounds = fail_slower.empty()
                          ? std::nullopt
                          : std::optional(parse_bounds("--fail-slower", fail_slower));
  return judge(std::span(&scene, 1), bounds);
}

std::vector<std::string> failed(const Judgements& judgements) {
  std::vector<std::string> all;
  for (const Verdict& verdict : judgements.verdicts) {
    if (verdict.outcome == Outcome::kFailed) all.push_back(verdict.what);
  }
  return all;
}

using Names = std::vector<std::string>;

TEST(Judge, JudgesEveryFigureByItsOwnBound) {
  const std::vector<Figures> before = repeats(kJudgedRepeats);
  for (const auto& [place, what, factor] :
       {std::tuple{"/stages/solve/cpu_mean_ms", "figure solve mean", 1.0},
        {"/frame/cpu_mean_ms", "figure frame mean", 1.0},
        {"/frame/cpu_p50_ms", "figure frame p50", 1.0},
        {"/frame/cpu_p95_ms", "figure frame p95", 1.0},
        {"/frame/cpu_p99_ms", "figure frame p99", 2.0},
        {"/frame/cpu_max_ms", "figure frame max", 4.0},
        {"/frame/p99_ms", "figure frame p99 (wall)", 2.0},
        {"/frame/max_ms", "figure frame max (wall)", 4.0},
        {"/memory_MB", "figure memory peak", 1.0}}) {
    std::vector<Figures> now = before;
    multiply(now, place, 1 + 0.06 * factor);
    EXPECT_EQ(failed(judged(now, before, "5%")), Names{what});
    EXPECT_TRUE(failed(judged(now, before, "7%")).empty()) << what;
    EXPECT_TRUE(failed(judged(now, before)).empty()) << what << ": no bounds, nothing fails";
    EXPECT_TRUE(failed(judged(before, now, "0%")).empty()) << what << ": faster is fine";
  }
  EXPECT_TRUE(failed(judged(before, before, "0%")).empty());
}

TEST(Judge, JudgesTheTimeOfDrawing) {
  std::vector<Figures> before = repeats(kJudgedRepeats), now = before;
  for (Figures& run : before) run["/draw/cpu_mean_ms"] = run["/draw/mean_ms"] = 10.0;
  for (Figures& run : now) run["/draw/cpu_mean_ms"] = run["/draw/mean_ms"] = 12.0;
  EXPECT_EQ(failed(judged(now, before, "5%")),
            (Names{"figure draw mean", "figure draw mean (wall)"}));
  EXPECT_TRUE(failed(judged(now, before, "5%,draw=25%")).empty());
}

TEST(Judge, OneRepeatOfFifteenMayDisagreeAndNotTwo) {
  const std::vector<Figures> before = repeats(15);
  std::vector<Figures> now = before;
  multiply(now, "/frame/cpu_mean_ms", 1.2);
  now[3]["/frame/cpu_mean_ms"] = 1.0;
  EXPECT_EQ(failed(judged(now, before, "5%")), Names{"figure frame mean"});
  now[8]["/frame/cpu_mean_ms"] = 1.0;
  EXPECT_TRUE(failed(judged(now, before, "5%")).empty());
}

TEST(Judge, TooFewRepeatsAreSaid) {
  const std::vector<Figures> before = repeats(5);
  std::vector<Figures> now = before;
  multiply(now, "/frame/cpu_mean_ms", 10);
  const Judgements few = judged(now, before, "5%");
  EXPECT_TRUE(few.has_too_few());
  EXPECT_TRUE(failed(few).empty());
  EXPECT_NE(judgements_table(few).find("5 pairs of runs, 16 figures: too few repeats to call "
                                       "anything slower or faster; that takes 9, by --repeats"),
            std::string::npos)
      << judgements_table(few);
  EXPECT_TRUE(std::ranges::all_of(
      few.verdicts, [](const Verdict& verdict) { return verdict.outcome == Outcome::kSkipped; }));
  const Judgements enough = judged(repeats(9), repeats(9), "5%");
  EXPECT_FALSE(enough.has_too_few());
  EXPECT_NE(judgements_table(enough).find("at most 5 % of commands on identical programs"),
            std::string::npos);
}

TEST(Judge, MoreFiguresTakeMoreRepeats) {
  EXPECT_EQ(least_repeats(1), 5u);
  EXPECT_EQ(least_repeats(kMaxPairedFigures), 9u);
  EXPECT_EQ(least_repeats(4 * kMaxPairedFigures), 11u);
  EXPECT_GT(std::size_t{kJudgedRepeats}, least_repeats(20 * kMaxPairedFiguresDrawn));
}

/// Plants a stall in `load`, at another frame of each of the given repeats. The figures of the run
/// change as those of a run with such a frame.
void plant_stalls(std::vector<Figures>& runs, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < first + count; ++i) {
    runs[i]["/per_frame/" + std::to_string(2 * i) + "/stages_ms/load"] = 41.0;
    runs[i]["/frame/max_ms"] = 47.0;
  }
}

TEST(Judge, AStallOfOneRepeatIsReportedAndNoReasonToFail) {
  const std::vector<Figures> before = repeats(15);
  std::vector<Figures> now = before;
  plant_stalls(now, 7, 1);
  const Judgements one = judged(now, before, "5%");
  EXPECT_TRUE(failed(one).empty());
  EXPECT_NE(judgements_table(one).find("1 repeats have more, 0 fewer"), std::string::npos)
      << judgements_table(one);
  EXPECT_EQ(number_at(median_of(now), "/stalls/longest/0/frame"), 15);
}

TEST(Judge, StallsAtAnotherFrameOfEachRepeatFail) {
  const std::vector<Figures> before = repeats(15);
  std::vector<Figures> now = before;
  plant_stalls(now, 0, 15);
  EXPECT_EQ(failed(judged(now, before, "5%")),
            (Names{"figure frame max (wall)", "figure frame stalls"}));
  EXPECT_TRUE(failed(judged(before, now, "5%")).empty()) << "fewer stalls are fine";
}

TEST(Judge, StallsOfHalfTheRepeatsFailIfTheRepeatsAreMany) {
  const std::vector<Figures> before = repeats(24);
  std::vector<Figures> now = before;
  plant_stalls(now, 0, 12);
  EXPECT_EQ(failed(judged(now, before, "5%")), Names{"figure frame stalls"})
      << "the median of the slowest frames is that before";
}

TEST(Judge, ShortTimesAreNotCompared) {
  std::vector<Figures> before = repeats(15), now = before;
  multiply(before, "/stages/act/cpu_mean_ms", 0.07);
  multiply(now, "/stages/act/cpu_mean_ms", 0.19);
  EXPECT_TRUE(failed(judged(now, before, "5%")).empty());
  EXPECT_NE(judgements_table(judged(now, before)).find("below 0.2 ms"), std::string::npos);
  multiply(now, "/stages/act/cpu_mean_ms", 1.5);
  EXPECT_EQ(failed(judged(now, before, "5%")), Names{"figure act mean"}) << "long enough";
}

TEST(Judge, WallTimeIsJudgedWithSeveralThreads) {
  std::vector<Figures> before = repeats(15);
  for (Figures& run : before) run["/threads"] = std::int64_t{2};
  std::vector<Figures> now = before;
  multiply(now, "/frame/cpu_mean_ms", 2);
  EXPECT_TRUE(failed(judged(now, before, "5%")).empty()) << "threads that wait use the processor";
  multiply(now, "/frame/mean_ms", 2);
  EXPECT_EQ(failed(judged(now, before, "5%")), Names{"figure frame mean (wall)"});
}

TEST(Judge, FiguresThatAnOlderProgramLacksAreLeftOut) {
  std::vector<Figures> before = repeats(15);
  for (Figures& run : before) run.erase("/memory_MB");
  const Judgements judgements = judged(repeats(15), before, "5%");
  EXPECT_EQ(judgements.figures.size(), kMaxPairedFigures - 1);
}

TEST(Judge, PairsAndJudgementsAreReadBackFromJson) {
  const std::vector<Figures> before = repeats(15);
  std::vector<Figures> now = before;
  multiply(now, "/frame/cpu_mean_ms", 1.2);
  std::vector<Figures> scenes = {median_of(now)};
  put_pairs(paired_figures(now, before), scenes[0]);
  put_judgements(judge(scenes, std::nullopt), scenes);
  const auto read = scenes_of(parse_figures(format_figures(document_of(scenes)), "x"), "x");
  EXPECT_EQ(failed(judge(read, parse_bounds("--fail-slower", "5%"))), Names{"figure frame mean"});
  EXPECT_EQ(text_at(read[0], "/against/figures/7/judgement"), "slower");
  EXPECT_DOUBLE_EQ(number_at(read[0], "/against/figures/7/low"), 1.2);
}

TEST(Bounds, AreReadAndNothingElse) {
  const Bounds bounds = parse_bounds("--fail-slower", "5%,max=50%,memory=2");
  EXPECT_DOUBLE_EQ(bounds.at("mean"), 0.05);
  EXPECT_DOUBLE_EQ(bounds.at("p99"), 0.1);
  EXPECT_DOUBLE_EQ(bounds.at("max"), 0.5);
  EXPECT_DOUBLE_EQ(bounds.at("memory"), 0.02);
  EXPECT_DOUBLE_EQ(parse_bounds("--fail-slower", "2.5").at("draw"), 0.025);
  for (const char* wrong : {"", "%", "ten", "10%%", "-5%", "inf", "nan", "1 0", "max=5%", "5%,",
                            "5%,max", "5%,solve=3%", "5%,max=x", "5%,max=3%,"}) {
    EXPECT_THROW(parse_bounds("--fail-slower", wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace sunder::scenes
