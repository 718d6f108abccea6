// Tests of reports on several timed runs.
#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"
#include "scenes/timing/timing_report.h"
#include "tests/engine/markup.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

TEST(MedianOf, TakesTheMedianOfEveryNumber) {
  std::vector<Figures> runs = {made_up_timings("house", 3), made_up_timings("house", 1),
                               made_up_timings("house", 2)};
  const Figures median = median_of(runs);
  EXPECT_EQ(number_at(median, "/stages/solve/cpu_mean_ms"), 2);
  EXPECT_EQ(number_at(median, "/repeats"), 3);
  EXPECT_DOUBLE_EQ(number_at(median, "/spread"), 1) << "7 to 21 ms about 14 ms";
  EXPECT_EQ(std::get<bool>(median.at("/differs")), false);
  runs[2]["/state_hash"] = std::string("another");
  EXPECT_EQ(std::get<bool>(median_of(runs).at("/differs")), true);
}

TEST(MedianOf, AnOutlierInAFrameOfOneRunChangesTheExtremesAndNothingElse) {
  std::vector<Figures> runs(3, made_up_timings("house", 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (const char* clock : {"stages_ms", "stages_cpu_ms"}) {
      const std::string frame = std::to_string(50 + 40 * i);
      runs[i]["/per_frame/" + frame + "/" + clock + "/solve"] = 1000.0 + static_cast<double>(i);
      runs[i]["/per_frame/" + std::to_string(7) + "/" + clock + "/solve"] = 3.0;
    }
    runs[i]["/frame/cpu_mean_ms"] = runs[i]["/stages/solve/cpu_mean_ms"] = 6.0;
  }
  const Figures median = median_of(runs);
  EXPECT_DOUBLE_EQ(number_at(median, "/stages/solve/cpu_mean_ms"), (199 + 3) / 200.0);
  EXPECT_EQ(number_at(median, "/stages/solve/p95_ms"), 1);
  EXPECT_EQ(number_at(median, "/stages/solve/p99_ms"), 1) << "6 of 600 frames are slower";
  EXPECT_EQ(number_at(median, "/stages/solve/max_ms"), 1002);
  EXPECT_EQ(number_at(median, "/frame/max_ms"), kStages - 1 + 1002);
  EXPECT_DOUBLE_EQ(number_at(median, "/frame/cpu_mean_ms"), (199.0 * kStages + kStages + 2) / 200);
  runs[1]["/per_frame/9/stages_ms/solve"] = 500.0;
  EXPECT_EQ(number_at(median_of(runs), "/stages/solve/p99_ms"), 3) << "7 of 600 frames are slower";
}

TEST(MedianOf, HasTheTimesOfDrawing) {
  std::vector<Figures> runs(3, made_up_timings("house", 1));
  for (std::size_t i = 0; i < 3; ++i) {
    runs[i]["/per_frame/99/draw_ms"] = 10.0 + static_cast<double>(i);
    runs[i]["/per_frame/199/draw_ms"] = 20.0;
  }
  const Figures median = median_of(runs);
  EXPECT_DOUBLE_EQ(number_at(median, "/draw/mean_ms"), (11 + 20) / 2.0);
  EXPECT_DOUBLE_EQ(number_at(median, "/draw/max_ms"), 20);
}

TEST(Document, IsReadAsItWasWritten) {
  std::vector<Figures> scenes;
  for (int i = 0; i < 12; ++i) scenes.push_back(made_up_timings("scene " + std::to_string(i), i));
  const std::string text = format_figures(document_of(scenes));
  EXPECT_EQ(format_figures(document_of(scenes_of(parse_figures(text, "x"), "x"))), text);
  const auto read = scenes_of(parse_figures(text, "x"), "x");
  ASSERT_EQ(read.size(), 12u);
  EXPECT_EQ(text_at(read[11], "/scene"), "scene 11");
  EXPECT_EQ(number_at(read[11], "/stages/solve/p50_ms"), 11);
}

TEST(Document, OfSimulateHasOneSceneAndOtherJsonIsRefused) {
  const auto read =
      scenes_of(parse_figures(format_figures(made_up_timings("house", 1)), "x.json"), "x.json");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(text_at(read[0], "/scene"), "house");
  for (const char* wrong : {"{}", "[]", "{\"scenes\": []}", "{\"scenes\": [{\"frames\": 3}]}",
                            "{\"scenes\": [3]}", "{\"scenes\": {\"x\": {\"scene\": \"y\"}}}"}) {
    try {
      scenes_of(parse_figures(wrong, "x.json"), "x.json");
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("x.json: "), 0u);
    }
  }
}

TEST(TimingReport, ShowsTheCostOfAFeatureAndIsWellFormed) {
  Figures scene = made_up_timings("<house>", 1);
  scene["/features/dust/cpu_mean_ms"] = 6.0;
  scene["/modelled/dust"] = std::string("on");
  ASSERT_EQ(savings_of(scene).size(), 1u);
  EXPECT_EQ(savings_of(scene)[0].feature, "dust");
  EXPECT_EQ(savings_of(scene)[0].with_ms - savings_of(scene)[0].without_ms, 1);
  const Verdict verdicts[] = {{"<house>", "state", Outcome::kFailed, "other & wrong"}};
  const Change changes[] = {{"<house>", "solve", "mean", "ms of wall time", 1, 2}};
  Judgements judgements;
  judgements.figures.emplace_back().scene = "<house>";
  judgements.figures.back().pair = {"solve", "p99", "ms of wall time", {2}, {1}};
  scene["/stalls/longest/0/ms"] = 48.0;
  const std::string page = timing_page(std::span(&scene, 1), verdicts, changes, judgements);
  EXPECT_EQ(tests::markup_mistake(page), "");
  for (const char* stage : kStageNames) EXPECT_NE(page.find(stage), std::string::npos) << stage;
  EXPECT_NE(page.find("other &amp; wrong"), std::string::npos);
  EXPECT_NE(page.find("solve p99"), std::string::npos);
  EXPECT_NE(page.find("too few repeats"), std::string::npos);
  EXPECT_NE(page.find("took 48.0 ms of wall time"), std::string::npos);
  EXPECT_NE(features_table(std::span(&scene, 1)).find("dust"), std::string::npos);
  EXPECT_EQ(features_table({}), "");
}

}  // namespace
}  // namespace sunder::scenes
