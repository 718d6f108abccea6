// Tests of stalls: frames that are slow in one repeat.
#include "scenes/timing/stalls.h"

#include <gtest/gtest.h>

#include "scenes/timing/timing.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

/// Five repeats whose frames take 7 ms, but for one: frame 132 of the third, which waits in `load`.
std::vector<Figures> with_a_stall() {
  std::vector<Figures> runs(5, made_up_timings("house", 1));
  runs[2]["/per_frame/131/stages_ms/load"] = 40.0;
  runs[2]["/per_frame/131/stages_ms/solve"] = 3.0;
  runs[2]["/per_frame/131/stages_cpu_ms/solve"] = 3.0;
  return runs;
}

TEST(Stalls, AFrameThatIsSlowInOneRepeatIsNamedWithItsStage) {
  const std::vector<Stall> stalls = find_stalls(with_a_stall());
  ASSERT_EQ(stalls.size(), 1u);
  EXPECT_EQ(stalls[0].repeat, 3);
  EXPECT_EQ(stalls[0].frame, 132);
  EXPECT_EQ(stalls[0].stage, "load");
  EXPECT_DOUBLE_EQ(stalls[0].ms, 48);
  EXPECT_DOUBLE_EQ(stalls[0].excess_ms, 41);
  EXPECT_DOUBLE_EQ(stalls[0].stage_excess_ms, 39);
  EXPECT_DOUBLE_EQ(stalls[0].processor_excess_ms, 2);
  EXPECT_EQ(count_stalls(stalls, 5), (std::vector<double>{0, 0, 1, 0, 0}));
}

TEST(Stalls, AreInTheMedianOfTheRepeatsAndInItsPercentiles) {
  const Figures median = median_of(with_a_stall());
  EXPECT_EQ(stall_lines(median, "house"),
            "house: stall: frame 132 of repeat 3 took 48.0 ms of wall time, 41.0 ms more than its "
            "median: 39.0 ms more in stage load, and 2.0 ms more of processor time\n");
  EXPECT_DOUBLE_EQ(number_at(median, "/frame/max_ms"), 48);
  EXPECT_DOUBLE_EQ(number_at(median, "/frame/p95_ms"), 7);
}

TEST(Stalls, FramesThatAreSlowInEveryRepeatAreNone) {
  std::vector<Figures> runs(5, made_up_timings("house", 1));
  for (Figures& run : runs) run["/per_frame/131/stages_ms/load"] = 40.0;
  EXPECT_TRUE(find_stalls(runs).empty());
  EXPECT_TRUE(find_stalls(std::span(runs).first(1)).empty()) << "nothing to compare with";
}

TEST(Stalls, SlowPicturesAreStallsOfTheStageDraw) {
  std::vector<Figures> runs(3, made_up_timings("house", 1));
  for (Figures& run : runs) run["/per_frame/9/draw_ms"] = 10.0;
  runs[0]["/per_frame/9/draw_ms"] = 60.0;
  const std::vector<Stall> stalls = find_stalls(runs);
  ASSERT_EQ(stalls.size(), 1u);
  EXPECT_EQ(stalls[0].stage, "draw");
  EXPECT_DOUBLE_EQ(stalls[0].excess_ms, 50);
}

TEST(Stalls, OnlyTheLongestArePrintedAndTheOthersCounted) {
  std::vector<Figures> runs(3, made_up_timings("house", 1));
  for (int frame = 0; frame < 30; ++frame)
    runs[1]["/per_frame/" + std::to_string(frame) + "/stages_ms/act"] = 50.0 + frame;
  const std::string text = stall_lines(median_of(runs), "house");
  EXPECT_EQ(text.find("house: stall: frame 30 of repeat 2 took 85.0 ms"), 0u) << text;
  EXPECT_NE(text.find("house: and 27 more stalled frames\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace sunder::scenes
