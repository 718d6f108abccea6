// Tests of the program: exit codes, messages and JSON.
#include "tests/scenes/program.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "engine/io/recording/recording.h"
#include "engine/model/frame.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"
#include "tests/engine/markup.h"

namespace sunder::tests::program_test {
namespace {

constexpr const char* kCommands[] = {"list",  "check", "simulate",   "render",
                                     "bench", "trade", "golden test"};

Figures figures(const std::string& arguments) {
  const Outcome outcome = sunder(arguments + " --quiet --json -");
  EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  return parse_figures(outcome.out, arguments);
}

TEST(Program, EveryCommandHasHelp) {
  for (const std::string command : kCommands) {
    const Outcome outcome = sunder(command + " --help");
    EXPECT_EQ(outcome.exit_code, 0) << command;
    for (const char* option : {"--threads", "--quiet", "--json"}) {
      EXPECT_NE(outcome.out.find(option), std::string::npos) << command << " " << option;
    }
  }
}

TEST(Program, WrongUseExitsWithTwoAndSaysWhy) {
  for (const std::string wrong :
       {"", "explode", "simulate", "simulate nowhere", "simulate stack --frames 0",
        "simulate stack --frames ten", "simulate stack --frames 100000",
        "simulate stack --preset fast", "simulate stack --set x", "simulate stack --speed 3",
        "check nowhere.toml", "render stack", "render stack -o x.png --frames 9:3",
        "render stack -o x.png --size 3", "render stack -o x.png --frames 100000:100001",
        "render stack -o x.png --gl vulkan", "bench stack --compare nowhere.json",
        "golden test nowhere", "golden accept"}) {
    const Outcome outcome = sunder(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong << "\n" << outcome.err;
    EXPECT_NE(outcome.err, "") << wrong;
  }
}

TEST(Program, SimulateSaysWhereASceneEnds) {
  const Outcome outcome = sunder("simulate stack --frames 2 --set scene.duration_s=0.1 --quiet");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Outcome past = sunder("simulate stack --frames 7 --set scene.duration_s=0.1");
  EXPECT_EQ(past.exit_code, 2);
  EXPECT_EQ(past.err, "error: --frames 7: stack ends with frame 6\n");
}

// A limit of 512 bytes per file has the effect of a full disk.
TEST(Program, AnUnwritableFileExitsWithOneAndNotTwo) {
  const Folder folder;
  const std::string run = "simulate stack --frames 2 --quiet ";
  const std::string draw = "render stack --frames 0:2 --size 64x48 --quiet ";
  const std::string cut = "fracture box:1,1,1 --pattern grid:3 --quiet ";
  const auto fails = [](const std::string& arguments, const std::string& before) {
    const Outcome outcome = sunder(arguments, before);
    EXPECT_EQ(outcome.exit_code, 1) << before << " " << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find("cannot be written"), std::string::npos) << outcome.err;
  };
  // Not even root makes files in /proc.
  for (const std::string& arguments :
       {run + "--take /proc/x.take", run + "--json /proc/x.json", draw + "-o /proc/x.png",
        cut + "-o /proc/x.glb", cut + "-o /proc/x/"}) {
    fails(arguments, "");
  }
  for (const std::string& arguments :
       {run + "--take " + folder / "x.take", run + "--json " + folder / "x.json",
        draw + "-o " + folder / "x.png", cut + "-o " + folder / "x.glb",
        cut + "-o " + folder / "y/"}) {
    fails(arguments, "trap '' XFSZ; ulimit -f 1;");
  }
  const int full = std::system("\"" SUNDER_PROGRAM "\" list --json - >/dev/full 2>/dev/null");
  EXPECT_EQ(WIFEXITED(full) ? WEXITSTATUS(full) : -1, 1);
}

TEST(Program, ListNamesTheScenes) {
  const Outcome outcome = sunder("list");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const scenes::CatalogEntry& entry : scenes::catalog()) {
    EXPECT_NE(outcome.out.find(entry.name + " "), std::string::npos) << entry.name;
  }
  EXPECT_TRUE(figures("list").contains("/scenes/0/description"));
}

TEST(Program, CheckReportsEverySceneItIsGiven) {
  const Folder folder;
  std::ofstream(folder / "bad.toml") << "[scene]\ndescription = \"x\"\nlength = 3\n";
  const Outcome outcome = sunder("check stack " + folder / "bad.toml" + " glass");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.out.find("stack: good"), std::string::npos);
  EXPECT_NE(outcome.out.find("glass: good"), std::string::npos);
  EXPECT_NE(outcome.err.find("bad.toml:3: unknown key 'length'"), std::string::npos);
}

TEST(Program, SimulateGivesItsFigures) {
  const Figures json = figures("simulate stack --frames 5 --preset draft --threads 1");
  for (const char* key : {"/scene",
                          "/preset",
                          "/threads",
                          "/frames",
                          "/dt_s",
                          "/substeps",
                          "/solver/max_colors",
                          "/solver/sweeps",
                          "/solver/lanes",
                          "/state_hash",
                          "/steps",
                          "/stages/collide/p50_ms",
                          "/stages/break/p95_ms",
                          "/stages/solve/max_ms",
                          "/frame/p50_ms",
                          "/frame/p95_ms",
                          "/frame/p99_ms",
                          "/frame/max_ms",
                          "/counts/bodies",
                          "/counts/awake",
                          "/counts/convexes",
                          "/counts/compounds",
                          "/counts/contacts",
                          "/counts/debris",
                          "/counts/dust",
                          "/peak/bodies",
                          "/fractures/events",
                          "/fractures/pieces",
                          "/fractures/p50_ms",
                          "/fractures/p99_ms",
                          "/fractures/max_ms",
                          "/fractures/carried_over",
                          "/fractures/failed",
                          "/penetration_m/p50",
                          "/penetration_m/p99",
                          "/penetration_m/max",
                          "/energy_J/kinetic",
                          "/energy_J/potential",
                          "/momentum_residual",
                          "/mass_kg/initial",
                          "/mass_kg/final",
                          "/limits_hit",
                          "/modelled/fracture",
                          "/cpu",
                          "/sunder_version"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(std::get<std::string>(json.at("/scene")), "stack");
  EXPECT_EQ(std::get<std::string>(json.at("/preset")), "draft");
  EXPECT_EQ(std::get<std::int64_t>(json.at("/counts/bodies")), 10);
}

TEST(Program, ChangesOnTheCommandLineChangeTheRun) {
  const Figures json = figures("simulate stack --frames 2 --set solid.0.count=3");
  EXPECT_EQ(std::get<std::int64_t>(json.at("/counts/bodies")), 3);
}

TEST(Program, APlanarSceneRunsWithoutAThirdDimensionAndSaysSo) {
  const Figures json = figures("simulate planar_wall --frames 40 --preset draft");
  EXPECT_EQ(std::get<std::string>(json.at("/modelled/third_dimension")),
            "off: planar = true, so Box2D simulates it");
  EXPECT_LT(std::get<double>(json.at("/momentum_residual")), 1e-4);
  const Figures solid = figures("simulate stack --frames 2");
  EXPECT_EQ(std::get<std::string>(solid.at("/modelled/third_dimension")), "on");
}

TEST(Program, QuietPrintsNothingAndJsonGoesToAFile) {
  const Folder folder;
  const Outcome outcome = sunder("simulate stack --frames 2 --quiet --json " + folder / "x.json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_TRUE(parse_figures(scenes::read_text(folder / "x.json"), "x").contains("/state_hash"));
}

TEST(Program, BenchPlotsEveryStage) {
  const Folder folder;
  ASSERT_EQ(sunder("bench stack --frames 5 --quiet --page " + folder / "x.html").exit_code, 0);
  const std::string page = scenes::read_text(folder / "x.html");
  EXPECT_EQ(markup_mistake(page), "");
  for (const char* stage : kStageNames) EXPECT_NE(page.find(stage), std::string::npos) << stage;
}

TEST(Program, BenchComparesOnlyRunsOfTheSameState) {
  const Folder folder;
  const std::string bench = "bench stack --frames 5 --quiet ";
  ASSERT_EQ(sunder(bench + "--json " + folder / "old.json").exit_code, 0);
  const Outcome same = sunder("bench stack --frames 5 --compare " + folder / "old.json");
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_NE(same.out.find("same state"), std::string::npos) << same.out;
  const Outcome other =
      sunder(bench + "--set scene.gravity=[0,-5,0] --compare " + folder / "old.json");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("the state differs"), std::string::npos) << other.err;
}

TEST(Program, AKilledRunLeavesAReadableRecording) {
  const Folder folder;
  const std::string recording = folder / "killed.take";
  // The run is killed once there are some frames in the file.
  const std::string line =
      "\"" SUNDER_PROGRAM "\" simulate brick_wall --quiet --take " + recording +
      " 2>/dev/null & run=$!; i=0; while [ $i -lt 600 ] && "
      "[ \"$(stat -c %s " +
      recording +
      " 2>/dev/null || echo 0)\" -lt 150000 ]; "
      "do sleep 0.05; i=$((i+1)); done; kill -9 $run; wait $run; [ $? -eq 137 ]";
  ASSERT_EQ(std::system(line.c_str()), 0) << "it ended before it was killed";
  RecordingReader reader(recording);
  EXPECT_FALSE(reader.is_complete());
  std::uint64_t frames = 0;
  while (const FramePtr frame = reader.next()) {
    EXPECT_EQ(frame->index, frames++);
    EXPECT_GE(frame->bodies.size(), 500u);
  }
  EXPECT_GT(frames, 1u);
  EXPECT_EQ(frames, reader.frames());
}

TEST(Program, RenderWritesThePictureItWasAskedFor) {
  const Folder folder;
  const std::string picture = folder / "stack.png";
  const Outcome outcome = sunder("render stack --frames 0:2 --size 64x48 -o " + picture);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(picture));
}

TEST(Program, RenderDrawsTheFramesItWasAskedFor) {
  const Folder folder;
  const std::string recording = folder / "s.take";
  ASSERT_EQ(sunder("simulate stack --frames 4 --quiet --take " + recording).exit_code, 0);
  const auto drawn = [&](const std::string& frames) {
    const std::string pictures = folder / ("frames" + frames + "/");
    const Figures written =
        figures("render " + recording + " --frames " + frames + " --size 64x48 -o " + pictures);
    std::set<std::string> names;
    for (const auto& picture : std::filesystem::directory_iterator(pictures))
      names.insert(picture.path().stem().string().substr(10));
    EXPECT_EQ(number_at(written, "/first_frame"), std::stoi(*names.begin()));
    EXPECT_EQ(number_at(written, "/last_frame"), std::stoi(*names.rbegin()));
    EXPECT_EQ(number_at(written, "/pictures"), static_cast<double>(names.size()));
    return names;
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(drawn("1:2"), (Names{"1", "2"}));
  EXPECT_EQ(drawn("3:"), (Names{"3", "4"}));
  EXPECT_EQ(drawn(":1"), (Names{"0", "1"}));
  EXPECT_EQ(drawn("2"), (Names{"2"}));
  for (const std::string wrong : {":", "2:1", "-1", "1:2:3", "x", "1:x", "99999999999"}) {
    const Outcome outcome =
        sunder("render " + recording + " -o " + folder / "x/ --frames=" + wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong;
    EXPECT_NE(outcome.err.find("expected A:B"), std::string::npos) << outcome.err;
  }
}

TEST(Program, SettingsOfARecordingMayChangeTheViewOnly) {
  const Folder folder;
  const std::string recording = folder / "s.take";
  ASSERT_EQ(sunder("simulate stack --frames 2 --quiet --take " + recording).exit_code, 0);
  const auto picture = [&](const std::string& options, const std::string& name) {
    const Outcome outcome = sunder("render " + recording + " --frames 1 --size 64x48 --quiet " +
                                   options + " -o " + folder / name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string plain = picture("", "a.png");
  EXPECT_NE(picture("--set view.fov_deg=20", "b.png"), plain);
  EXPECT_NE(picture("--set view.sun=[-1,1,0]", "c.png"), plain);
  EXPECT_NE(picture("--set view.eye=[0,1,0]", "e.png"), plain);
  EXPECT_EQ(picture("", "d.png"), plain);
  for (const std::string wrong :
       {"--set scene.seed=2", "--set foo.bar=1", "--set view.far=1", "--preset draft",
        "--set view.eye=[0,1,0] --set view.target=[0,1,0]"}) {
    const Outcome outcome = sunder("render " + recording + " " + wrong + " -o " + folder / "x.png");
    EXPECT_EQ(outcome.exit_code, 2) << wrong;
    EXPECT_NE(outcome.err.find("s.take"), std::string::npos) << outcome.err;
  }
}

TEST(Program, AStoppedCommandKeepsItsOutputsAndLeavesNoOtherFiles) {
  const Folder folder;
  const auto stopped = [&](const std::string& arguments, const std::string& until,
                           const std::string& signal) {
    const std::string line = "\"" SUNDER_PROGRAM "\" " + arguments +
                             " >/dev/null 2>&1 & run=$!; i=0; while [ $i -lt 1200 ] && ! ( " +
                             until + " ); do sleep 0.05; i=$((i+1)); done; kill -" + signal +
                             " $run; wait $run";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const std::string pictures = folder / "p/";
  EXPECT_EQ(stopped("render brick_wall --size 64x48 -o " + pictures,
                    "[ -e " + pictures + "frame_00003.png ]", "TERM"),
            143);
  for (const auto& picture : std::filesystem::directory_iterator(pictures))
    EXPECT_EQ(picture.path().extension(), ".png");
  const std::string none = folder / "n/";
  EXPECT_EQ(stopped("render brick_wall --frames 350: --speed 0.5 --size 64x48 -o " + none,
                    "[ -d " + none + " ]", "TERM"),
            143)
      << "also before the first picture";
  EXPECT_TRUE(std::filesystem::is_empty(none));
  const std::string recording = folder / "t.take";
  EXPECT_EQ(
      stopped("simulate brick_wall --take " + recording,
              "[ \"$(stat -c %s " + recording + " 2>/dev/null || echo 0)\" -gt 100000 ]", "TERM"),
      143);
  EXPECT_TRUE(RecordingReader(recording).is_complete());
  if (std::system("ffprobe -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
  const std::string video = folder / "v.mp4";
  for (const auto& [signal, code] : {std::pair{"TERM", 143}, {"HUP", 129}}) {
    EXPECT_EQ(stopped("render brick_wall --size 64x48 -o " + video,
                      "ls " + video + ".part-* >/dev/null 2>&1 && sleep 1", signal),
              code);
    EXPECT_EQ(std::system(("ffprobe -v error " + video).c_str()), 0) << signal;
    EXPECT_NE(std::system(("ls " + video + ".part-* >/dev/null 2>&1").c_str()), 0) << signal;
    std::filesystem::remove(video);
  }
}

}  // namespace
}  // namespace sunder::tests::program_test
