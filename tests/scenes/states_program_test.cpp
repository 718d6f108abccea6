// Tests of `sunder simulate` that goes on from saved states, and that is compared with recordings.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/file/text_file.h"
#include "tests/scenes/program.h"

namespace sunder::tests::states_program_test {
namespace {

using Json = nlohmann::json;

/// Removes all times and the memory, which differ from run to run.
void remove_times(Json& json) {
  if (json.is_object()) {
    for (auto it = json.begin(); it != json.end();) {
      const bool is_time = it.key().ends_with("_ms") || it.key() == "ms" || it.key() == "ns_each" ||
                           it.key() == "memory_MB";
      if (!is_time) remove_times(*it);
      it = is_time ? json.erase(it) : std::next(it);
    }
  } else if (json.is_array()) {
    for (Json& element : json) remove_times(element);
  }
}

/// Returns the lines after the table of times, without the longest time of a break.
std::string counts_in(const std::string& out) {
  std::istringstream lines(out);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("wrote ")) continue;
    if (line.starts_with("bodies ")) text.clear();
    text += line.substr(0, line.find(", slowest plan")) + "\n";
  }
  return text;
}

/// Three blocks that are shot at, at 0.1 and 0.4 s, and a shot between that hits nothing.
class States : public ::testing::Test {
 protected:
  States() { write_scene(scene_, 40); }
  static void write_scene(const std::string& file, int speed_m_s) {
    std::ofstream out(file);
    out << "[scene]\ndescription = \"Blocks that are shot at.\"\nduration_s = 0.7\n"
           "[limits]\ndebris = 20\n";
    for (const char* x : {"0", "3", "6"})
      out << "[[solid]]\nstructure = \"box\"\nname = \"block" << x
          << "\"\nsize_m = [1, 2, 1]\nposition = [" << x << ", 0, 0]\nanchored = \"bottom\"\n";
    out << "[[script.shot]]\nname = \"first\"\ntime_s = 0.1\nfrom = [0, 1, 6]\nat = [0, 1, 0]\n"
           "speed_m_s = 40\n"
           "[[script.shot]]\nname = \"missed\"\ntime_s = 0.2\nfrom = [0, 9, 6]\nat = [0, 30, 0]\n"
           "speed_m_s = 40\n"
           "[[script.shot]]\nname = \"second\"\ntime_s = 0.4\nfrom = [3, 1, 6]\nat = [3, 1, 0]\n"
           "speed_m_s = "
        << speed_m_s << "\n";
  }
  Outcome simulate(const std::string& arguments) {
    return sunder("simulate " + arguments + " --json " + folder_ / "run.json");
  }
  Json json() {
    Json figures = Json::parse(scenes::read_text(folder_ / "run.json"));
    remove_times(figures);
    return figures;
  }

  Folder folder_;
  std::string scene_ = folder_ / "blocks.toml";
  std::string recording_ = folder_ / "blocks.take";
};

TEST_F(States, ARunThatGoesOnReportsTheCountsOfTheWholeRun) {
  const Outcome whole = simulate(scene_ + " --preset draft");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const Json expected = json();
  EXPECT_EQ(expected["preset"], "draft");
  EXPECT_EQ(expected["frames"], 42);
  EXPECT_GT(expected["limits_hit"], 0);
  EXPECT_NE(whole.err.find("limits were reached"), std::string::npos) << whole.err;
  EXPECT_NE(whole.out.find("'missed' at 0.2 s hit nothing"), std::string::npos) << whole.out;
  const std::string first = folder_ / "first.state", second = folder_ / "second.state";
  const Outcome saved = simulate(scene_ + " --preset draft --frames 18 --save-at 0.3 " + first);
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  const Json half = json();
  EXPECT_GT(half["fractures"]["events"], 0) << "it breaks before";
  EXPECT_GT(half["limits_hit"], 0);
  for (const std::string& state : {first, second}) {
    const Outcome rest =
        simulate("--resume " + state + (state == first ? " --save-at 0.5 " + second : ""));
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(json(), expected);
    EXPECT_EQ(counts_in(rest.out), counts_in(whole.out));
    EXPECT_EQ(rest.err.substr(rest.err.find("warning: limits")),
              whole.err.substr(whole.err.find("warning: limits")));
  }
  EXPECT_GT(expected["fractures"]["events"], half["fractures"]["events"]) << "it breaks after";
  EXPECT_EQ(simulate("--resume " + first + " --frames 18").exit_code, 0);
  EXPECT_EQ(json(), half) << "no frame is counted twice";
}

TEST_F(States, AFolderOfImagesThatIsContinuedReportsTheWholeRun) {
  const auto render = [&](const std::string& options) {
    const Outcome outcome = sunder("render " + scene_ + " --preset draft --size 32x32 " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  };
  const std::string folder = folder_ / "images/";
  const Outcome whole = render("--frames :20 -o " + folder);
  for (int i = 11; i <= 20; ++i)
    std::filesystem::remove(folder + "frame_000" + std::to_string(i) + ".png");
  const Outcome rest = render("--frames :20 --resume -o " + folder);
  EXPECT_NE(whole.out.find("'missed' at 0.2 s hit nothing"), std::string::npos) << whole.out;
  EXPECT_EQ(rest.out, whole.out);
  ASSERT_NE(whole.err.find("warning: limits"), std::string::npos) << whole.err;
  EXPECT_EQ(rest.err.substr(rest.err.find("warning: limits")),
            whole.err.substr(whole.err.find("warning: limits")));
}

TEST_F(States, ARunThatDiffersFromARecordingStopsThere) {
  ASSERT_EQ(simulate(scene_ + " --quiet --preset draft --take " + recording_).exit_code, 0);
  const std::string other = folder_ / "other.toml";
  write_scene(other, 41);
  const std::string verify = other + " --preset draft --verify " + recording_;
  const Outcome stopped = simulate(verify);
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_NE(stopped.err.find("frame 25 differs, after 25 equal frames: "), std::string::npos)
      << stopped.err;
  EXPECT_NE(stopped.err.find(" 'second': "), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.err.find("velocity (0, "), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.err.find("-41) m/s, recorded "), std::string::npos) << stopped.err;
  EXPECT_EQ(json()["frames"], 25);
  const Outcome on = simulate(verify + " --keep-going");
  EXPECT_EQ(on.exit_code, 1);
  EXPECT_NE(on.err.find("; in all, 18 of 43 frames differ\n"), std::string::npos) << on.err;
  EXPECT_EQ(json()["frames"], 42);
}

TEST_F(States, ARecordingOfAnotherLengthIsSaidToBe) {
  const std::string run = scene_ + " --preset draft --quiet ";
  ASSERT_EQ(simulate(run + "--frames 20 --take " + recording_).exit_code, 0);
  const Outcome longer = simulate(run + "--verify " + recording_);
  EXPECT_EQ(longer.exit_code, 1);
  EXPECT_NE(longer.err.find("21 frames match the recording; it ends with frame 20 and the run goes "
                            "on: compare the frames that both have by --frames 20\n"),
            std::string::npos)
      << longer.err;
  EXPECT_EQ(json()["frames"], 21);
  const Outcome shorter = simulate(scene_ + " --preset draft --frames 7 --verify " + recording_);
  EXPECT_EQ(shorter.exit_code, 0) << shorter.err;
  EXPECT_NE(shorter.out.find("8 frames match the recording; it is longer than the run, by 13 "
                             "frames\n"),
            std::string::npos)
      << shorter.out;
  std::filesystem::resize_file(recording_, std::filesystem::file_size(recording_) / 2);
  const Outcome damaged = simulate(run + "--verify " + recording_);
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_NE(damaged.err.find("truncated or corrupt"), std::string::npos) << damaged.err;
  EXPECT_NE(damaged.err.find("frames match before that"), std::string::npos) << damaged.err;
}

}  // namespace
}  // namespace sunder::tests::states_program_test
