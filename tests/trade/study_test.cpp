// Tests of a study, which is the same list of runs for every worker, and of the files of runs.
#include "scenes/trade/study.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/file/schema.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"
#include "scenes/trade/run_file.h"
#include "tests/scenes/program.h"

namespace sunder::scenes {
namespace {

using tests::Folder;

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Study study(int seeds) {
  Study given;
  given.scenes = {"stack", "glass"};
  given.points = default_points();
  given.seeds = seeds;
  return given;
}

std::vector<std::string> names_of(const std::vector<StudyRun>& runs) {
  std::vector<std::string> names;
  for (const StudyRun& run : runs) names.push_back(run.name());
  return names;
}

TEST(Points, TheGridHasTwelvePointsWithEveryPresetAndAFinerLimit) {
  const std::vector<StudyPoint> points = default_points();
  ASSERT_EQ(points.size(), 13u);
  EXPECT_TRUE(points.back().is_limit());
  for (const Preset& preset : presets()) {
    EXPECT_EQ(std::count_if(points.begin(), points.end(),
                            [&](const StudyPoint& point) {
                              return point.is_preset() && point.name == preset.name;
                            }),
              1)
        << preset.name;
  }
  // Substeps of the limit are at most a quarter as long as those of any point.
  Study given = study(1);
  given.scenes = {"stack"};
  double finest = 1, limit = 1;
  for (const StudyRun& run : study_runs(given)) {
    const Scene scene = load_scene(run);
    const double substep_s = scene.accuracy.dt_s / scene.accuracy.substeps;
    (run.point.is_limit() ? limit : finest) =
        std::min(run.point.is_limit() ? limit : finest, substep_s);
  }
  EXPECT_LE(limit, finest / 4);
}

TEST(Points, APresetIsNoCheaperThanTheOneBeforeIt) {
  const std::span<const Preset> all = presets();
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Preset &coarse = all[i - 1], &fine = all[i];
    EXPECT_LE(fine.accuracy.dt_s, coarse.accuracy.dt_s) << fine.name << ": collisions";
    EXPECT_LE(coarse.accuracy.substeps * coarse.sweeps / coarse.accuracy.dt_s,
              fine.accuracy.substeps * fine.sweeps / fine.accuracy.dt_s)
        << fine.name << ": sweeps";
  }
}

TEST(Points, AFileHasOnePointPerLine) {
  const auto points = parse_points(
      "# comment\n\nlimit reference\ncoarse draft  accuracy.substeps=2 ground.friction=0 # more\n",
      "x.txt");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].name, "coarse");
  EXPECT_EQ(points[0].preset, "draft");
  EXPECT_EQ(points[0].set, (std::vector<std::string>{"accuracy.substeps=2", "ground.friction=0"}));
  EXPECT_EQ(points[1].name, "limit");
  EXPECT_TRUE(points[1].set.empty());
  EXPECT_EQ(parse_points("draft draft\n", "x.txt").back().set, default_points().back().set);
}

TEST(Points, MistakesAreNamedWithTheirLine) {
  const auto said = [](const std::string& text) {
    return refusal([&] { parse_points(text, "x.txt"); });
  };
  EXPECT_EQ(said("a draft\na realtime\n"), "x.txt:2: duplicate point 'a'");
  EXPECT_EQ(
      said("a/b draft\n"),
      "x.txt:1: 'a/b' is not a valid name of a point; allowed: letters, digits and . _ + = -");
  EXPECT_EQ(said("a\n"), "x.txt:1: expected NAME PRESET KEY=VALUE...");
  EXPECT_EQ(said("a draft substeps\n"), "x.txt:1: expected KEY=VALUE, got 'substeps'");
  EXPECT_EQ(said("a fast\n"),
            "x.txt:1: unknown preset 'fast'; allowed: draft, realtime, accurate, reference");
  EXPECT_EQ(said("limit draft\n"), "x.txt: has no point besides the limit; add at least one");
}

TEST(Points, ASwitchIsTriedAtEveryPreset) {
  std::vector<StudyPoint> points = default_points();
  add_switch(points, "limits.dust=0");
  ASSERT_EQ(points.size(), 17u);
  EXPECT_TRUE(points.back().is_limit());
  EXPECT_EQ(points[12].name, "draft+limits.dust=0");
  EXPECT_EQ(points[12].set, std::vector<std::string>{"limits.dust=0"});
  EXPECT_EQ(refusal([&] { add_switch(points, "dust"); }), "--switch dust: expected KEY=VALUE");
}

TEST(Points, TheLimitIsAlsoRunWithLongerSteps) {
  std::vector<StudyPoint> points = parse_points(
      "draft draft\nlimit reference accuracy.dt_s=0.0020833333333333333 solver.sweeps=8\n", "");
  add_coarser_limits(points, {});
  ASSERT_EQ(points.size(), 4u);
  EXPECT_TRUE(points.back().is_limit());
  EXPECT_EQ(points[1].name, "limit_4h");
  EXPECT_EQ(points[2].name, "limit_2h");
  Study given = study(1);
  given.points = points;
  const std::vector<StudyRun> runs = study_runs(given);
  for (const auto& [run, steps] : {std::pair(1, 120), {2, 240}, {3, 480}}) {
    const Scene scene = load_scene(runs[static_cast<std::size_t>(run)]);
    EXPECT_NEAR(scene.accuracy.dt_s, 1.0 / steps, 1e-9);
    EXPECT_EQ(scene.solver.sweeps, 8);
  }
  add_coarser_limits(points, {});
  EXPECT_EQ(points.size(), 4u) << "they are there";
}

TEST(Points, NoLimitHasStepsLongerThanAFrame) {
  std::vector<StudyPoint> points = parse_points("draft draft\nlimit accurate\n", "");
  add_coarser_limits(points, {});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[1].name, "limit_2h");
  points = parse_points("draft draft\nlimit accurate\n", "");
  add_coarser_limits(points, {"accuracy.dt_s=0.016666666666666666"});
  EXPECT_EQ(points.size(), 2u);
}

TEST(Runs, LimitsHaveSeedsOfTheirOwn) {
  Study given = study(8);
  given.scenes = {"stack"};
  add_coarser_limits(given.points, given.set);
  std::map<std::string, std::set<std::uint64_t>> seeds;
  for (const StudyRun& run : study_runs(given)) {
    const std::uint64_t seed = load_scene(run).seed;
    EXPECT_EQ(seed, static_cast<std::uint64_t>(run.scene_seed()));
    seeds[run.point.is_limit() || run.point.is_coarser_limit() ? run.point.name : "points"].insert(
        seed);
  }
  ASSERT_EQ(seeds.size(), 4u);
  std::set<std::uint64_t> all;
  for (const auto& [name, of_point] : seeds) {
    EXPECT_EQ(of_point.size(), 8u) << name;
    all.insert(of_point.begin(), of_point.end());
  }
  EXPECT_EQ(all.size(), 4u * 8u) << "no run of a limit has the seed of another";
}

/// Returns a scene of a ball that is shot at a box, in steps of 1/120 s.
Scene shot_scene() {
  return parse_scene(
      "[scene]\ndescription = \"x\"\nduration_s = 2\n[[solid]]\nstructure = \"box\"\nmaterial = "
      "\"wood\"\n[script]\n[[script.shot]]\ntime_s = 0.1\nfrom = [0, 0.5, 4]\nat = [0, 0.5, 0]\n"
      "speed_m_s = 20\nradius_m = 0.1\n",
      "shot.toml", {"realtime", {}});
}

TEST(Phase, EachSeedShiftsTheStartAndTheEventsInRelationToTheSteps) {
  constexpr int kCount = 64;
  std::vector<double> starts, events;
  for (int seed = 1; seed <= kCount; ++seed) {
    const auto source = make_shifted_simulation(shot_scene(), seed);
    std::vector<double> times_s;
    for (int i = 0; i < 20; ++i) times_s.push_back(source->next()->time_s);
    double event = 0;
    for (std::size_t i = 1; i < times_s.size(); ++i) {
      const double longer = 60 * (times_s[i] - times_s[i - 1]) - 1;
      if (i == 1) {
        starts.push_back(longer);
      } else if (longer > 1e-6) {
        EXPECT_GE(times_s[i - 1], 0.1 - 1e-9) << "the first frame after the shot";
        EXPECT_LT(times_s[i - 1], 0.1 + 1.0 / 60);
        EXPECT_EQ(event, 0) << "there is one event";
        event = longer;
      } else {
        EXPECT_NEAR(longer, 0, 1e-6);
      }
    }
    events.push_back(event);
  }
  for (std::vector<double>* phases : {&starts, &events}) {
    std::ranges::sort(*phases);
    for (int i = 0; i < kCount; ++i)  // uniform: no farther off than 1 of 1000 samples would be
      EXPECT_NEAR((*phases)[static_cast<std::size_t>(i)], (i + 0.5) / kCount, 0.25);
  }
}

TEST(Phase, AShotMeetsItsTargetAtAnyPartOfAStep) {
  std::set<int> tenths;
  for (int seed = 1; seed <= 64; ++seed) {
    const auto source = make_shifted_simulation(shot_scene(), seed);
    double steps_left = 0;  // from the end of the tenth frame to the impact
    for (int i = 0; i <= 10; ++i) {
      const FramePtr frame = source->next();
      for (const FrameBody& body : frame->bodies)
        if (body.velocity_W.z() < -19) steps_left = (body.X_WB.position.z() - 0.6) / 20 * 120;
    }
    ASSERT_GT(steps_left, 0);
    tenths.insert(static_cast<int>(10 * (steps_left - std::floor(steps_left))));
  }
  EXPECT_EQ(tenths.size(), 10u);
}

TEST(Runs, PointsAlternateWithinASeedAndEveryRunHasItsName) {
  const std::vector<StudyRun> runs = study_runs(study(3));
  ASSERT_EQ(runs.size(), 2u * 13u * 3u);
  EXPECT_EQ(runs[0].name(), "stack/draft-1");
  EXPECT_EQ(runs[12].name(), "stack/limit-1");
  EXPECT_EQ(runs[13].name(), "stack/draft-2");
  EXPECT_EQ(runs[39].name(), "glass/draft-1");
  const auto names = names_of(runs);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), runs.size());
  EXPECT_EQ(load_scene(runs[13]).seed, 2u);
}

TEST(Runs, SharesPartitionThem) {
  const std::vector<StudyRun> runs = study_runs(study(3));
  const auto all = names_of(runs);
  for (const int count : {1, 2, 5, 8, 78, 100}) {
    std::multiset<std::string> shared;
    for (int i = 1; i <= count; ++i) {
      const auto share = names_of(share_of(runs, {i, count}));
      EXPECT_LE(share.size(), runs.size() / static_cast<std::size_t>(count) + 1);
      shared.insert(share.begin(), share.end());
    }
    EXPECT_EQ(shared, std::multiset<std::string>(all.begin(), all.end())) << count;
  }
}

TEST(Runs, SharesAreCountedFromOne) {
  EXPECT_EQ(parse_shard("3/8").index, 3);
  EXPECT_EQ(parse_shard("3/8").count, 8);
  for (const char* wrong : {"0/8", "9/8", "3", "3/", "3/8x", "/8", "a/b", "-1/2", "1/0"}) {
    EXPECT_NE(refusal([&] { parse_shard(wrong); }), "accepted") << wrong;
  }
}

TEST(Runs, TwoScenesOfOneNameAreRefused) {
  Study given = study(1);
  given.scenes = {"stack", std::string(SUNDER_ROOT) + "/scenes/stacks/stack.toml"};
  EXPECT_NE(refusal([&] { study_runs(given); }), "accepted");
}

StudyRun short_run() {
  Study given = study(1);
  given.frames = 3;
  return study_runs(given).front();
}

Ran some_facts() {
  Ran ran;
  ran.result.facts.samples = {
      {"speed m/s", {0.1, 1.0 / 3, -2e-300}}, {"a~b/c~1 m", {5}}, {"nothing m", {}}};
  ran.result.facts.state_hash = "0123456789abcdef";
  ran.time = {1.5, 2.5, 3};
  return ran;
}

TEST(RunFile, IsReadAsItWasWritten) {
  const Folder folder;
  const Ran ran = some_facts();
  EXPECT_EQ(read_run(folder.path(), short_run()).missing, "not run yet");
  write_run(folder.path(), short_run(), ran);
  const StoredRun stored = read_run(folder.path(), short_run());
  EXPECT_EQ(stored.missing, "");
  EXPECT_EQ(stored.ran.result.facts.samples, ran.result.facts.samples);
  EXPECT_EQ(stored.ran.result.facts.state_hash, ran.result.facts.state_hash);
  EXPECT_EQ(stored.ran.result.failed, "");
  EXPECT_EQ(stored.ran.time.cpu_ms, 1.5);
  EXPECT_EQ(stored.ran.time.wall_ms, 2.5);
  EXPECT_EQ(stored.ran.time.frames, 3);
}

TEST(RunFile, DoesNotDependOnTheTimes) {
  const Folder folder;
  const std::string file = folder / "runs/stack/draft-1.json";
  Ran ran = some_facts();
  write_run(folder.path(), short_run(), ran);
  const std::string text = read_text(file);
  ran.time = {99, 98, 97};
  write_run(folder.path(), short_run(), ran);
  EXPECT_EQ(read_text(file), text);
}

TEST(RunFile, OfAnotherStudyIsDoneAgain) {
  const Folder folder;
  write_run(folder.path(), short_run(), some_facts());
  const auto changed = [&](const std::function<void(StudyRun&)>& change) {
    StudyRun run = short_run();
    change(run);
    const StoredRun stored = read_run(folder.path(), run);
    return stored.damaged ? stored.missing : "the same";
  };
  const std::string other = "belongs to another study";
  EXPECT_EQ(changed([](StudyRun&) {}), "the same");
  EXPECT_EQ(changed([](StudyRun& run) { run.frames = 4; }), other);
  EXPECT_EQ(changed([](StudyRun& run) { run.frames = -1; }), other);
  EXPECT_EQ(changed([](StudyRun& run) { run.scene_hash = "0"; }), other);
  EXPECT_EQ(changed([](StudyRun& run) { run.point.preset = "accurate"; }), other);
  EXPECT_EQ(changed([](StudyRun& run) { run.set.push_back("ground.friction=0"); }), other);
  EXPECT_EQ(changed([](StudyRun& run) { run.set.pop_back(); }), other);
}

TEST(RunFile, WithoutShiftedStepsIsDoneAgain) {
  const Folder folder;
  write_run(folder.path(), short_run(), some_facts());
  const std::string file = folder / "runs/stack/draft-1.json";
  std::string text = read_text(file);
  const std::string key = "\"steps\": \"shifted by the seed\"";
  const std::size_t at = text.find(key);
  ASSERT_NE(at, std::string::npos) << text;
  std::ofstream(file) << text.replace(at, key.size(), "\"steps\": \"\"");
  EXPECT_EQ(read_run(folder.path(), short_run()).missing, "belongs to another study");
}

TEST(RunFile, TruncatedOrWithoutItsTimesIsDoneAgain) {
  const Folder folder;
  write_run(folder.path(), short_run(), some_facts());
  std::filesystem::remove(folder / "times/stack/draft-1.json");
  EXPECT_TRUE(read_run(folder.path(), short_run()).damaged);
  write_run(folder.path(), short_run(), some_facts());
  std::filesystem::resize_file(folder / "runs/stack/draft-1.json", 100);
  EXPECT_TRUE(read_run(folder.path(), short_run()).damaged);
}

TEST(RunFile, KeepsTheReasonOfAFailure) {
  const Folder folder;
  Ran ran;
  ran.result.failed = "body 3 is not finite in frame 2";
  write_run(folder.path(), short_run(), ran);
  EXPECT_EQ(read_run(folder.path(), short_run()).ran.result.failed, ran.result.failed);
}

TEST(CarryOut, GivesTheSameFactsEveryTime) {
  const Ran once = carry_out(short_run()), again = carry_out(short_run());
  EXPECT_EQ(once.result.failed, "");
  EXPECT_EQ(once.time.frames, 3);
  EXPECT_FALSE(once.result.facts.samples.empty());
  EXPECT_EQ(once.result.facts.state_hash.size(), 16u);
  EXPECT_EQ(once.result.facts.samples, again.result.facts.samples);
  EXPECT_EQ(once.result.facts.state_hash, again.result.facts.state_hash);
}

/// A source of frames of one body, which throws at the fifth frame or gives it a velocity of NaN.
class FailingSource final : public FrameSource {
 public:
  explicit FailingSource(bool throws) : throws_(throws) {}
  FramePtr next() override {
    if (index_ == 4 && throws_) throw std::runtime_error("out of hand");
    auto frame = std::make_shared<Frame>();
    frame->index = index_;
    frame->time_s = static_cast<double>(index_) / 60;
    frame->materials = std::make_shared<std::vector<Material>>();
    frame->meshes = std::make_shared<MeshStore>();
    frame->bodies.resize(1);
    frame->bodies[0].key = 7;
    frame->report.counts.bodies = 1;
    frame->report.mass_kg = 1;
    if (index_ == 4) frame->bodies[0].velocity_W.y() = std::numeric_limits<double>::quiet_NaN();
    ++index_;
    return frame;
  }

 private:
  bool throws_;
  std::uint64_t index_ = 0;
};

TEST(CarryOut, AFailedRunIsAResult) {
  const Ran thrown = measure([] { return std::make_unique<FailingSource>(true); }, 10);
  EXPECT_EQ(thrown.result.failed, "out of hand");
  EXPECT_TRUE(thrown.result.facts.samples.empty());
  const Ran infinite = measure([] { return std::make_unique<FailingSource>(false); }, 10);
  EXPECT_EQ(infinite.result.failed, "body 7 is not finite in frame 4");
  EXPECT_TRUE(infinite.result.facts.samples.empty());
  EXPECT_EQ(measure([] { return std::make_unique<FailingSource>(false); }, 3).result.failed, "");
  const Ran none = measure([]() -> std::unique_ptr<FrameSource> { throw InputError("no"); }, 3);
  EXPECT_EQ(none.result.failed, "no");
}

}  // namespace
}  // namespace sunder::scenes
