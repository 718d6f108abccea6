// Tests of traces and of the work log of a frame.
#include "engine/base/trace.h"

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/io/figures.h"
#include "engine/io/trace_file.h"
#include "engine/model/work_log.h"

namespace sunder {
namespace {

TEST(Trace, KeepsSpansOnlyWhileItIsOn) {
  { const TraceSpan before("before"); }
  start_trace();
  EXPECT_EQ(current_span_name(), nullptr);
  {
    const TraceSpan outer("outer");
    { const TraceSpan inner("inner"); }
    EXPECT_STREQ(current_span_name(), "outer");
  }
  const std::vector<TracedSpan> spans = stop_trace();
  { const TraceSpan after("after"); }
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_STREQ(spans[0].name, "inner");
  EXPECT_STREQ(spans[1].name, "outer");
  EXPECT_GE(spans[0].begin_us, spans[1].begin_us);
  EXPECT_LE(spans[0].begin_us + spans[0].duration_us, spans[1].begin_us + spans[1].duration_us);
  EXPECT_TRUE(stop_trace().empty());
}

TEST(Trace, WorkOfOtherThreadsInALoopHasTheNameOfTheEnclosingSpan) {
  set_threads(4);
  start_trace();
  {
    const TraceSpan span("loop");
    std::atomic<int> inside = 0;  // keeps each thread in the loop until others have entered
    for_chunks(64, 1, [&](std::size_t, std::size_t, std::size_t) {
      ++inside;
      for (int i = 0; i < 1000 && inside < 64; ++i) std::this_thread::yield();
    });
  }
  set_threads(0);
  for (const TracedSpan& span : stop_trace()) EXPECT_STREQ(span.name, "loop");
}

TEST(Trace, IsWrittenAsEventsThatBrowsersOpen) {
  const TracedSpan spans[] = {{"collide", 0, 10, 5}, {"collide \"two\"", 3, 11, 2.5}};
  const Figures figures = parse_figures(format_trace(spans), "trace");
  EXPECT_EQ(std::get<std::string>(figures.at("/traceEvents/0/name")), "collide");
  EXPECT_EQ(std::get<std::string>(figures.at("/traceEvents/1/name")), "collide \"two\"");
  EXPECT_EQ(std::get<std::string>(figures.at("/traceEvents/1/ph")), "X");
  EXPECT_EQ(std::get<double>(figures.at("/traceEvents/1/dur")), 2.5);
  EXPECT_EQ(std::get<std::int64_t>(figures.at("/traceEvents/1/tid")), 3);
  EXPECT_EQ(std::get<std::string>(figures.at("/traceEvents/3/args/name")), "thread 3");
}

TEST(WorkLog, AddsUpItemsOfOneStageAndName) {
  WorkLog log;
  log.add({Stage::kSolve, "points", 3, 1.5});
  log.add({Stage::kCollide, "points", 5, 0});
  log.add({Stage::kSolve, "points", 4, 0.5});
  {
    WorkSpan span(log, Stage::kLoad, "solids");
    span.count(2);
    span.count(1);
  }
  const std::vector<WorkItem> items = log.take();
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].count, 7u);
  EXPECT_EQ(items[0].ms, 2);
  EXPECT_EQ(items[1].count, 5u);
  EXPECT_EQ(items[2].count, 3u);
  EXPECT_TRUE(log.take().empty());
}

}  // namespace
}  // namespace sunder
