// Tests of `sunder render`: cameras, rates and sheets of scenes, recordings and stored frames.
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A recording of a ball that breaks a block.
class Film : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new Folder;
    std::ofstream(scene()) << R"([scene]
description = "A block, and a ball that breaks it."
duration_s = 0.5
[[solid]]
structure = "box"
name = "block"
size_m = [1, 2, 1]
anchored = "bottom"
[[script.shot]]
name = "shot"
time_s = 0.1
from = [0, 1, 8]
at = [0, 1, 0]
speed_m_s = 40
)";
    const Outcome outcome =
        sunder("simulate " + scene() + " --preset draft --quiet --take " + recording());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete shared_; }
  static std::string scene() { return *shared_ / "block.toml"; }
  static std::string recording() { return *shared_ / "block.take"; }

  /// Returns the bytes of the picture that `sunder render` writes.
  std::string drawn(const std::string& arguments) {
    const std::string picture = folder_ / "x.png";
    const Outcome outcome = sunder("render " + arguments + " --size 64x48 --quiet -o " + picture);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return bytes_of(picture);
  }
  void expect_refused(const std::string& arguments, const std::string& word) {
    const Outcome outcome = sunder("render " + arguments + " --quiet");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
  }

  Folder folder_;

 private:
  static Folder* shared_;
};
Folder* Film::shared_ = nullptr;

TEST_F(Film, ARecordingIsDrawnByEveryCamera) {
  const std::string path = folder_ / "path.toml";
  std::ofstream(path) << "[[key]]\ntime_s = 0\neye = [9, 2, 0]\n[[key]]\ntime_s = 0.5\n"
                         "fov_deg = 20\ntarget = [0, 0, 0]\n";
  std::set<std::string> pictures;
  for (const std::string& view :
       std::initializer_list<std::string>{"fixed", "orbit:2", "follow:shot", "auto", path})
    pictures.insert(drawn(recording() + " --frames 20 --view " + view));
  pictures.insert(drawn(recording() + " --frames 20 --set view.ground_color=[1,0,0]"));
  EXPECT_EQ(pictures.size(), 6u);
  EXPECT_EQ(pictures.count(drawn(recording() + " --frames 19:20 --view auto")), 1u)
      << "the view does not depend on the frames drawn before";
}

TEST_F(Film, OptionsThatDoNotApplyAreRefusedByName) {
  const std::string x = " -o " + folder_ / "x.png";
  expect_refused(recording() + " --set solid.0.size_m=[1,1,1]" + x, "--set solid.0.size_m=[1,1,1]");
  expect_refused(recording() + " --set foo.bar=1" + x, "view.fov_deg=30");
  expect_refused(recording() + " --set view.key.0.time_s=1" + x, "--view FILE.toml");
  expect_refused(recording() + " --preset draft" + x, "has been simulated");
  expect_refused(recording() + " --view spiral" + x, "fixed | orbit[:SECONDS]");
  expect_refused(recording() + " --view nowhere.toml" + x, "nowhere.toml");
  expect_refused(recording() + " --speed 0" + x, "--speed");
  expect_refused(recording() + " --fps 0" + x, "--fps");
  expect_refused(recording() + " --sheet 4 -o " + folder_ / "x.mp4", "does not end in .png");
  const std::string frame = SUNDER_ROOT "/tests/golden/stack.frame";
  for (const char* flag : {"--frames 2", "--speed 0.5", "--fps 30", "--sheet 4"})
    expect_refused(frame + " " + flag + x, "is a single frame");
  const std::string path = folder_ / "path.toml";
  const auto path_says = [&](const std::string& text, const std::string& word) {
    std::ofstream(path) << text;
    expect_refused(recording() + " --view " + path + x, word);
  };
  path_says("# none\n", "at least one [[key]]");
  path_says("[[key]]\ntime_s = 1\n[[key]]\ntime_s = 1\n", "path.toml:4: time_s in [[key]] is 1");
  path_says("[[key]]\ntime_s = 1\neyes = 2\n", "did you mean 'eye'?");
  path_says("[view]\n", "unknown key 'view'");
}

TEST_F(Film, ARunIsShownAtAnyRate) {
  const auto pictures = [&](const std::string& options) {
    const Outcome outcome = sunder("render " + recording() + " --size 32x32 --quiet --json - " +
                                   options + " -o " + folder_ / "p/");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return std::get<std::int64_t>(parse_figures(outcome.out, "x").at("/pictures"));
  };
  EXPECT_EQ(pictures("--frames 10:11 --speed 0.25"), 5);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "p/frame_00040.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "p/frame_00044.png"));
  EXPECT_EQ(pictures("--frames :10 --fps 24"), 5);
}

TEST_F(Film, ASheetHasPicturesOfAnySizeSideBySide) {
  const std::string sheet = folder_ / "s.png";
  const Outcome outcome =
      sunder("render " + recording() + " --sheet 5 --size 65x49 --quiet -o " + sheet);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string png = bytes_of(sheet);  // width and height are in bytes 16 to 23, big-endian
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(static_cast<std::uint8_t>(png[19]), 3 * 65 + 2 * 4);
  EXPECT_EQ(static_cast<std::uint8_t>(png[23]), 2 * 49 + 4);
}

TEST_F(Film, ASceneMayDefineThePathOfItsCamera) {
  const std::string moving = folder_ / "moving.toml";
  std::filesystem::copy_file(scene(), moving);
  std::ofstream(moving, std::ios::app) << "[[view.key]]\ntime_s = 0\neye = [9, 2, 0]\n";
  EXPECT_EQ(drawn(moving + " --preset draft --frames 2"),
            drawn(scene() + " --preset draft --frames 2 --set view.eye=[9,2,0]"));
}

/// Programs in place of ffmpeg that open their output, and then neither read nor end.
constexpr const char* kHangs[] = {"exec sleep 1000", "sleep 1000; :", "kill -STOP $$"};

class Hanging : public Film {
 protected:
  /// Renders a video with a program in place of ffmpeg, and sends a signal. Returns the exit code;
  /// 99 if the command has not ended ten seconds later.
  int signalled(const std::string& hang, const std::string& options, const std::string& signal) {
    const std::string program = folder_ / "bin/ffmpeg", group = folder_ / "group";
    std::filesystem::create_directories(folder_ / "bin");
    std::filesystem::remove(group);
    std::ofstream(program) << "#!/bin/sh\nfor last; do :; done\n: >\"$last\"\necho $$ >" << group
                           << "\n"
                           << hang << "\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    std::ofstream(folder_ / "run.sh")
        << "PATH=" << folder_ / "bin"
        << ":$PATH\n\"" SUNDER_PROGRAM "\" render " << recording() << " --size 64x48 --quiet -o "
        << folder_ / "out/v.mp4"
        << " " << options << " >/dev/null 2>" << folder_ / "err"
        << " & run=$!\n"
           "i=0; while [ $i -lt 1200 ] && ! [ -s "
        << group << " ]; do sleep 0.05; i=$((i+1)); done\nsleep 1\nkill -" << signal
        << " $run\ni=0; while [ $i -lt 200 ] && kill -0 $run 2>/dev/null; do sleep 0.05; "
           "i=$((i+1)); done\n"
           "if kill -9 $run 2>/dev/null; then code=99; else wait $run; code=$?; fi\n"
           "exit $code\n";
    const int status = std::system(("sh " + folder_ / "run.sh").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void expect_nothing_left() {
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out"));
    const int group = std::stoi(bytes_of(folder_ / "group"));
    EXPECT_FALSE(has_processes(group));
    ::kill(-group, SIGKILL);
  }
  /// Returns true if a process group has a process that has not ended.
  static bool has_processes(int group) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(entry.path() / "stat");
      std::string stat;  // PID (NAME) STATE PARENT GROUP
      std::getline(file, stat);
      std::istringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
      char state = 'Z';
      int parent = 0, of = 0;
      if (fields >> state >> parent >> of && of == group && state != 'Z') return true;
    }
    return false;
  }
};

TEST_F(Hanging, FfmpegIsKilledAfterASignalAndNothingIsLeft) {
  for (const char* hang : kHangs) {
    EXPECT_EQ(signalled(hang, "", "TERM"), 143) << hang << ": while frames are sent";
    EXPECT_NE(bytes_of(folder_ / "err").find("ffmpeg hangs"), std::string::npos)
        << bytes_of(folder_ / "err");
    expect_nothing_left();
  }
  EXPECT_EQ(signalled(kHangs[0], "--frames :2", "INT"), 130) << "after all frames";
  expect_nothing_left();
}

TEST_F(Hanging, FfmpegIsKilledWhenTheProgramEndsAtOnce) {
  for (const auto& [signal, code] :
       {std::pair{"PIPE", 141}, {"TERM $run; sleep 0.6; kill -TERM", 143}}) {
    EXPECT_EQ(signalled(kHangs[0], "", signal), code) << signal;
    expect_nothing_left();
  }
}

}  // namespace
}  // namespace sunder::tests
