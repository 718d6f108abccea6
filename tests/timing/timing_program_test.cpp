// Tests of the command `sunder bench`. Timings in the files that it writes are replaced by made-up
// ones, so that no test depends on a clock.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/file/text_file.h"
#include "tests/engine/markup.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

using Json = nlohmann::json;

/// A ball that falls for a fifth of a second, timed and accepted.
class Bench : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "fall.toml") << "[scene]\ndescription = \"x\"\nduration_s = 0.2\n"
                                            "[[ball]]\nposition = [0, 5, 0]\n";
    const Outcome outcome =
        bench(folder_ / "fall.toml" + " --repeats 2 --warm-up 0 --accept --json " + file("now"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    timings_ = Json::parse(scenes::read_text(file("now")));
    Json& scene = timings_["scenes"][0];
    for (auto& stage : scene["stages"]) {
      for (auto& figure : stage) figure = 1.0;
    }
    for (auto& figure : scene["frame"]) figure = 7.0;
    write("old");
  }
  Outcome bench(const std::string& arguments) const {
    return sunder("bench --hashes " + folder_ / "hashes.txt" + " " + arguments);
  }
  std::string file(const std::string& name) const { return folder_ / (name + ".json"); }
  /// Writes the timings to the file of this name.
  void write(const std::string& name) const { std::ofstream(file(name)) << timings_.dump(); }
  Json& scene() { return timings_["scenes"][0]; }

  Folder folder_;
  Json timings_;
};

TEST_F(Bench, AcceptsAStateAndComparesRunsWithIt) {
  const std::string book = scenes::read_text(folder_ / "hashes.txt");
  EXPECT_NE(book.find("state/fall/realtime/12"), std::string::npos) << book;
  const Outcome same = bench("--from " + file("now"));
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_NE(same.out.find("equal to the stored state"), std::string::npos) << same.out;
  const Outcome longer = bench(folder_ / "fall.toml" + " --repeats 1 --warm-up 0");
  EXPECT_EQ(longer.exit_code, 0) << longer.err;
}

TEST_F(Bench, OneDifferentBitOfTheStateFails) {
  std::string hash = scene()["state"]["hash"];
  hash.back() = "1032547698badcfe"[std::stoi(hash.substr(hash.size() - 1), nullptr, 16)];
  scene()["state"]["hash"] = hash;
  write("planted");
  const Outcome outcome = bench("--quiet --from " + file("planted"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("failed: fall, state: "), std::string::npos) << outcome.err;
}

TEST_F(Bench, TwoFilesAreComparedAndNotJudged) {
  for (const std::string clock : {"cpu_", ""}) {
    for (const std::string figure : {"p50_ms", "mean_ms"}) {
      scene()["stages"]["solve"][clock + figure] = 110.0;
    }
  }
  write("planted");
  const std::string compare = "--from " + file("planted") + " --compare " + file("old");
  const Outcome said = bench(compare);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("+10900.0 %"), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find("slower"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("two files cannot tell"), std::string::npos) << said.out;
  const Outcome refused = bench(compare + " --fail-slower 5%");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("use --against PROGRAM"), std::string::npos) << refused.err;
}

TEST_F(Bench, FilesOfAnotherGovernorAreRefused) {
  scene()["machine"]["governor"] = "another";
  write("planted");
  const Outcome outcome = bench("--from " + file("now") + " --compare " + file("planted"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("fall, same machine: times are not comparable: machine/governor is "
                             "another in "),
            std::string::npos)
      << outcome.err;
}

TEST_F(Bench, TheJsonSaysWhatWasBuiltAndWhereItRan) {
  const Json json = Json::parse(scenes::read_text(file("now")))["scenes"][0];
  EXPECT_NE(json["commit"], "");
  for (const char* key : {"compiler", "flags", "processor", "type"})
    EXPECT_TRUE(json["build"].contains(key)) << key;
  for (const char* key : {"kernel", "governor", "processors", "instructions", "omp_proc_bind"})
    EXPECT_NE(json["machine"][key], "") << key;
  EXPECT_EQ(json["at_once"], 1);
  EXPECT_GT(json["memory_MB"], 1);
  EXPECT_EQ(json["state"]["frames"], 12) << "of the whole scene, which is short";
  EXPECT_NE(sunder("--version").out.find("commit " + json["commit"].get<std::string>()),
            std::string::npos);
}

TEST_F(Bench, RunsOfSimulateHaveTheStateOfSoManyFrames) {
  const auto state = [&](const std::string& options) {
    EXPECT_EQ(sunder("simulate " + folder_ / "fall.toml" + " --quiet --json " + file("run") + " " +
                     options)
                  .exit_code,
              0);
    const Json json = Json::parse(scenes::read_text(file("run")));
    return json.contains("state") ? json["state"]["hash"].get<std::string>() : "none";
  };
  EXPECT_EQ(state(""), scene()["state"]["hash"]);
  EXPECT_EQ(state("--frames 12"), scene()["state"]["hash"]);
  EXPECT_EQ(state("--frames 11"), "none");
  EXPECT_NE(state("--set scene.gravity=[0,-9,0]"), scene()["state"]["hash"]);
}

TEST_F(Bench, ASceneThatTheOlderFileLacksFails) {
  scene()["scene"] = "rise";
  write("other");
  const Outcome outcome = bench("--from " + file("now") + " --compare " + file("other"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("fall, same run: not in "), std::string::npos) << outcome.err;
}

TEST_F(Bench, AcceptsAFileOfSimulateAsOlderTimings) {
  ASSERT_EQ(sunder("simulate " + folder_ / "fall.toml" + " --threads 1 --quiet --json " +
                   file("simulated"))
                .exit_code,
            0);
  const Outcome outcome = bench("--from " + file("now") + " --compare " + file("simulated"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("same state as in"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("processor"), std::string::npos) << outcome.out;
}

TEST_F(Bench, AnotherProgramIsTimedInTurnsAndCompared) {
  const std::string fall = folder_ / "fall.toml" + " --repeats 2 --warm-up 0 --against ";
  const Outcome same = bench(fall + SUNDER_PROGRAM);
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_NE(same.out.find("fall, same run: same state as in"), std::string::npos) << same.out;
  EXPECT_NE(same.out.find("2 pairs of runs, 16 figures: too few repeats to call anything slower"),
            std::string::npos)
      << same.out;

  std::ofstream(folder_ / "other")
      << "#!/bin/sh\nexec \"" SUNDER_PROGRAM "\" \"$@\" --set scene.gravity=[0,-9,0]\n";
  std::filesystem::permissions(folder_ / "other", std::filesystem::perms::owner_all);
  const Outcome other = bench(fall + folder_ / "other");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("the state differs"), std::string::npos) << other.err;
  EXPECT_EQ(other.out.find("pairs of runs"), std::string::npos) << "times are not judged";
  EXPECT_EQ(bench(fall + folder_ / "fall.toml").exit_code, 2) << "no program";
  EXPECT_EQ(bench(fall + "/bin/false").exit_code, 1);
}

TEST_F(Bench, ComparedProgramsRunAsCopiesOfWhichNoneIsLeft) {
  const std::string temporary = folder_ / "temporary";
  std::filesystem::create_directory(temporary);
  const std::string command = "bench " + folder_ / "fall.toml" + " --hashes " +
                              folder_ / "hashes.txt" + " --repeats 2 --warm-up 0 --against " +
                              SUNDER_PROGRAM;
  const Outcome outcome = sunder(command, "TMPDIR=" + temporary + " ");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
  const Outcome nowhere = sunder(command, "TMPDIR=" + folder_ / "nowhere" + " ");
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_NE(nowhere.err.find("set TMPDIR to a folder"), std::string::npos) << nowhere.err;
}

TEST_F(Bench, PairsOfRunsAreJudgedAgainFromTheirFile) {
  const Outcome timed = bench(folder_ / "fall.toml" + " --repeats 9 --warm-up 0 --against " +
                              SUNDER_PROGRAM + " --fail-slower 1000000% --json " + file("pairs"));
  EXPECT_EQ(timed.exit_code, 0) << timed.err;
  timings_ = Json::parse(scenes::read_text(file("pairs")));
  Json& memory = scene()["against"]["figures"][15];
  ASSERT_EQ(memory["what"], "memory") << memory;
  memory["before"] = std::vector<double>(9, 100.0);
  memory["now"] = std::vector<double>(9, 111.0);
  for (std::size_t i = 0; i < 15; ++i) {
    Json& figure = scene()["against"]["figures"][i];
    figure["now"] = figure["before"] = std::vector<double>(9, 1.0);
  }
  write("planted");
  const Outcome failed = bench("--from " + file("planted") + " --fail-slower 10%");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err,
            "failed: fall, figure memory peak: 100 MB before, 111 now; change +11.0 "
            "to +11.0 %, slower by more than 10 %\n");
  EXPECT_EQ(bench("--from " + file("planted") + " --fail-slower 12%").exit_code, 0);
  EXPECT_EQ(bench("--from " + file("planted") + " --fail-slower 10%,memory=12%").exit_code, 0);
  EXPECT_NE(bench("--from " + file("planted")).out.find("slower"), std::string::npos);
}

TEST_F(Bench, AGateThatCouldNeverFailIsRefused) {
  const Outcome few = bench(folder_ / "fall.toml" + " --repeats 8 --against " + SUNDER_PROGRAM +
                            " --fail-slower 5%");
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_NE(few.err.find("--repeats 8: too few for --fail-slower, which judges up to 16 figures"),
            std::string::npos)
      << few.err;
  EXPECT_NE(few.err.find("give --repeats 9 or more"), std::string::npos) << few.err;
  const Outcome none = bench("--from " + file("now") + " --fail-slower 5%");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("has no pairs of runs"), std::string::npos) << none.err;
}

TEST_F(Bench, FramesAreDrawnAndTheirTimesReported) {
  const Outcome outcome =
      bench(folder_ / "fall.toml" + " --repeats 1 --warm-up 0 --draw 5 --json " + file("drawn") +
            " --against " + SUNDER_PROGRAM);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(scenes::read_text(file("drawn")))["scenes"][0];
  EXPECT_EQ(json["draw"]["pictures"], 2) << "frames 5 and 10";
  EXPECT_GT(json["per_frame"][4]["draw_ms"], 0);
  EXPECT_FALSE(json["per_frame"][5].contains("draw_ms"));
  EXPECT_NE(outcome.out.find("draw mean"), std::string::npos) << outcome.out;
  EXPECT_EQ(json["state"]["hash"], scene()["state"]["hash"]) << "drawing changes no state";
}

TEST_F(Bench, KeepsAndReportsFinishedRepeatsWhenStopped) {
  const auto stopped = [&](const std::string& what) {
    return sunder("bench " + what + " --hashes " + folder_ / "hashes.txt" + " --json " +
                      file("stopped") + " --junit " + folder_ / "stopped.xml",
                  "timeout --preserve-status -s INT -k 60 2 ");
  };
  const Outcome outcome = stopped(folder_ / "fall.toml" + " --repeats 1000 --warm-up 0");
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_NE(outcome.out.find("stopped; results of the runs that were timed"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("fall: realtime"), std::string::npos) << outcome.out;
  const Json json = Json::parse(scenes::read_text(file("stopped")));
  ASSERT_EQ(json["scenes"].size(), 1u);
  const int repeats = json["scenes"][0]["repeats"];
  EXPECT_GE(repeats, 1);
  EXPECT_LT(repeats, 1000);
  EXPECT_EQ(json["scenes"][0]["repeat_ms"]["frame"]["processor"].size(), repeats);
  EXPECT_NE(scenes::read_text(folder_ / "stopped.xml").find("name=\"state\""), std::string::npos);
  std::filesystem::remove(file("stopped"));
  const Outcome nothing = stopped("house --repeats 1 --warm-up 1000");
  EXPECT_EQ(nothing.exit_code, 130) << nothing.err;
  EXPECT_NE(nothing.out.find("stopped before the first scene was timed"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("stopped")));
}

TEST_F(Bench, TwoSignalsAtOnceStopItOnceAndALaterOneEndsIt) {
  const auto signalled = [&](const std::string& scene, const std::string& signals) {
    const std::string shell = "sh -c '\"$@\" & p=$!; sleep 2; " + signals + "; wait $p' sh ";
    return sunder("bench " + scene + " --repeats 1000 --warm-up 0 --hashes " +
                      folder_ / "hashes.txt" + " --json " + file("signalled"),
                  shell)
        .exit_code;
  };
  const std::string twice = "kill $p; kill $p";
  EXPECT_EQ(signalled(folder_ / "fall.toml", twice), 143);
  EXPECT_TRUE(std::filesystem::exists(file("signalled"))) << "results are kept";
  std::filesystem::remove(file("signalled"));
  EXPECT_EQ(signalled("tower", twice + "; sleep 1; kill $p"), 143);
  EXPECT_FALSE(std::filesystem::exists(file("signalled"))) << "ended within its first run";
}

TEST_F(Bench, AnotherProgramSharesOneProcessorWithThisOne) {
  const std::string seen = folder_ / "seen";
  std::ofstream(folder_ / "other") << "#!/bin/sh\ngrep Cpus_allowed_list /proc/self/status >> \""
                                   << seen << "\"\nexec \"" SUNDER_PROGRAM "\" \"$@\"\n";
  std::filesystem::permissions(folder_ / "other", std::filesystem::perms::owner_all);
  const Outcome outcome =
      bench(folder_ / "fall.toml" + " --repeats 3 --warm-up 0 --against " + folder_ / "other");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream lines(scenes::read_text(seen));
  int runs = 0;
  for (std::string line; std::getline(lines, line); ++runs) {
    EXPECT_EQ(line.find_first_of(",-", line.find(':')), std::string::npos) << line;
  }
  EXPECT_EQ(runs, 3);
}

TEST_F(Bench, ReportsTheCostOfFeaturesAndWritesPageAndJunit) {
  const Outcome outcome =
      bench(folder_ / "fall.toml" + " --repeats 1 --warm-up 0 --features --json " +
            file("features") + " --page " + folder_ / "x.html" + " --junit " + folder_ / "x.xml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(scenes::read_text(file("features")));
  EXPECT_TRUE(json["scenes"][0]["features"].contains("sleeping"));
  EXPECT_FALSE(json["scenes"][0]["features"].contains("dust")) << "the scene has no dust";
  EXPECT_NE(outcome.out.find("sleeping"), std::string::npos);
  EXPECT_EQ(markup_mistake(scenes::read_text(folder_ / "x.html")), "");
  const std::string xml = scenes::read_text(folder_ / "x.xml");
  EXPECT_NE(xml.find("name=\"state\""), std::string::npos) << xml;
}

TEST_F(Bench, WrongUseExitsWithTwoAndAMessage) {
  std::ofstream(folder_ / "bad.txt") << "state/fall/realtime/12 wrong\n";
  std::ofstream(folder_ / "bad.json") << "{\"frames\": 3}";
  std::ofstream(folder_ / "no.json") << "{";
  const std::string from = "--from " + file("now");
  for (const std::string& wrong : std::vector<std::string>{
           from + " --fail-slower 5%", "stack --fail-slower 5%",
           "stack --fail-slower ten --against " + std::string(SUNDER_PROGRAM),
           "stack --fail-slower 5%,solve=3% --against " + std::string(SUNDER_PROGRAM),
           from + " --draw 5", from + " --accept", from + " --features", from + " stack",
           from + " --compare " + file("bad"), from + " --compare " + file("no"),
           "--from " + file("nowhere"), "nowhere", "stack stack --frames 1", "stack --repeats 0",
           folder_ / "fall.toml" + " --frames 5 --repeats 1 --warm-up 0 --accept",
           from + " --hashes " + folder_ / "bad.txt"}) {
    const Outcome outcome = bench(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong << "\n" << outcome.err;
    EXPECT_NE(outcome.err, "") << wrong;
  }
  EXPECT_NE(sunder("bench " + from + " --hashes " + folder_ / "bad.txt").err.find("bad.txt:1: "),
            std::string::npos);
}

}  // namespace
}  // namespace sunder::tests
