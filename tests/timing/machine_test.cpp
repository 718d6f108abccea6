// Tests of the facts about a run and its machine.
#include "scenes/timing/machine.h"

#include <sched.h>

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/timing/timing.h"

namespace sunder::scenes {
namespace {

TEST(Machine, NamesTheProcessorsThatTheRunMayUse) {
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  const int processor = sched_getcpu();
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(processor), &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const Figures figures = machine_figures();
  sched_setaffinity(0, sizeof all, &all);
  EXPECT_EQ(text_at(figures, "/machine/processors"), std::to_string(processor));
  for (const char* place : {"/machine/kernel", "/machine/governor", "/machine/instructions",
                            "/machine/omp_proc_bind", "/machine/omp_places"})
    EXPECT_NE(text_at(figures, place), "") << place;
}

TEST(Machine, PeakMemoryGrowsWithWhatIsUsed) {
  const double before_MB = peak_memory_MB();
  EXPECT_GT(before_MB, 1);
  const std::vector<char> block(64 << 20, 1);
  EXPECT_GT(peak_memory_MB(), before_MB + 32) << block.back();
}

TEST(Machine, TheStateIsThatOfAFixedNumberOfFrames) {
  StateHash states;
  Frame frame;
  for (int i = 0; i <= 13; ++i) {
    frame.index = static_cast<std::uint64_t>(i);
    states.take(std::make_shared<Frame>(frame));
  }
  const Figures whole = state_figures(states, 12);
  EXPECT_EQ(number_at(whole, "/state/frames"), 12) << "the scene ends there";
  EXPECT_EQ(text_at(whole, "/state/hash"), states.hex(13));
  EXPECT_TRUE(state_figures(states, kStateFrames).empty()) << "the run was shorter";
}

}  // namespace
}  // namespace sunder::scenes
