// Tests of timed runs and of reports on several of them.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"
#include "scenes/timing/timing_report.h"
#include "tests/engine/markup.h"
#include "tests/timing/planted.h"

namespace sunder::scenes {
namespace {

using tests::made_up_timings;

/// A ball that falls for a fifth of a second.
class Fall : public testing::Test {
 protected:
  Fall() {
    std::ofstream(file_) << "[scene]\ndescription = \"x\"\nduration_s = 0.2\n[[ball]]\n"
                            "position = [0, 5, 0]\n";
  }
  ~Fall() override { std::filesystem::remove(file_); }

  Figures run(int frames, const std::vector<std::string>& set = {}) const {
    TimedRun run;
    run.scene = file_;
    run.load.set = set;
    run.frames = frames;
    return time_run(run, false);
  }

 private:
  std::string file_ = (std::filesystem::temp_directory_path() /
                       ("sunder-fall-" + std::to_string(getpid()) + ".toml"))
                          .string();
};

TEST_F(Fall, HasTheFiguresOfEveryStageByBothClocks) {
  const Figures figures = run(5);
  for (const std::string stage : kStageNames) {
    for (const std::string figure : {"p50_ms", "p95_ms", "p99_ms", "max_ms", "mean_ms"}) {
      EXPECT_TRUE(figures.contains("/stages/" + stage + "/" + figure));
      EXPECT_TRUE(figures.contains("/stages/" + stage + "/cpu_" + figure));
    }
    EXPECT_TRUE(figures.contains("/per_frame/4/stages_cpu_ms/" + stage));
  }
  EXPECT_GT(number_at(figures, "/frame/cpu_mean_ms"), 0);
  EXPECT_GT(number_at(figures, "/memory_MB"), 1);
  EXPECT_EQ(number_at(figures, "/peak/bodies"), 1);
}

TEST_F(Fall, TheStateHashIsOfAFixedNumberOfFrames) {
  const Figures whole = run(1000), again = run(12), shorter = run(11);
  EXPECT_EQ(number_at(whole, "/frames"), 12) << "to the end of the scene";
  EXPECT_EQ(number_at(whole, "/state/frames"), 12);
  EXPECT_EQ(text_at(whole, "/state/hash"), text_at(again, "/state/hash"));
  EXPECT_FALSE(shorter.contains("/state/hash"));
  const Figures other = run(12, {"scene.gravity=[0, -9, 0]"});
  EXPECT_NE(text_at(other, "/state/hash"), text_at(again, "/state/hash"));
  EXPECT_EQ(text_at(other, "/set/0"), "scene.gravity=[0, -9, 0]");
}

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

TEST(MedianOf, AnOutlierInAFrameOfOneRunChangesNothing) {
  std::vector<Figures> runs(3, made_up_timings("house", 1));
  for (std::size_t i = 0; i < 3; ++i) {
    for (const char* clock : {"stages_ms", "stages_cpu_ms"}) {
      const std::string frame = std::to_string(50 + 40 * i);
      runs[i]["/per_frame/" + frame + "/" + clock + "/solve"] = 1000.0;
      runs[i]["/per_frame/" + std::to_string(7) + "/" + clock + "/solve"] = 3.0;
    }
    runs[i]["/frame/cpu_mean_ms"] = runs[i]["/stages/solve/cpu_mean_ms"] = 6.0;
    runs[i]["/stages/solve/max_ms"] = 1000.0;
  }
  const Figures median = median_of(runs);
  EXPECT_DOUBLE_EQ(number_at(median, "/stages/solve/cpu_mean_ms"), (199 + 3) / 200.0);
  EXPECT_EQ(number_at(median, "/stages/solve/max_ms"), 3) << "slow in every run";
  EXPECT_EQ(number_at(median, "/frame/max_ms"), kStages - 1 + 3);
  EXPECT_DOUBLE_EQ(number_at(median, "/frame/cpu_mean_ms"), (199.0 * kStages + kStages + 2) / 200);
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
  const Change changes[] = {{"<house>", "solve", "mean", true, 1, 2}};
  const std::string page = timing_page(std::span(&scene, 1), verdicts, changes);
  EXPECT_EQ(tests::markup_mistake(page), "");
  for (const char* stage : kStageNames) EXPECT_NE(page.find(stage), std::string::npos) << stage;
  EXPECT_NE(page.find("other &amp; wrong"), std::string::npos);
  EXPECT_NE(features_table(std::span(&scene, 1)).find("dust"), std::string::npos);
  EXPECT_EQ(features_table({}), "");
}

}  // namespace
}  // namespace sunder::scenes
