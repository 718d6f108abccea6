// Tests that outputs of a command never replace its inputs, nor devices, pipes and links.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scenes/program.h"

namespace sunder::tests::outputs_program_test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Outputs : public ::testing::Test {
 protected:
  Outputs() {
    std::ofstream(scene_) << "[scene]\ndescription = \"a block\"\nduration_s = 0.2\n"
                             "[[solid]]\nstructure = \"box\"\nsize_m = [1, 1, 1]\n";
    std::ofstream(mesh_) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  }
  void expect_refused(const std::string& arguments, const std::string& input) {
    const std::string before = bytes_of(input);
    const Outcome outcome = sunder(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
    EXPECT_EQ(bytes_of(input), before) << arguments;
    EXPECT_NE(outcome.err.find("give another"), std::string::npos) << outcome.err;
  }

  Folder folder_;
  std::string scene_ = folder_ / "in.toml", mesh_ = folder_ / "piece_1.obj";
};

TEST_F(Outputs, ThatAreInputsAreRefused) {
  fs::create_symlink(scene_, folder_ / "link.toml");
  fs::create_hard_link(scene_, folder_ / "hard.toml");
  fs::create_directory(folder_ / "sub");
  const std::string simulate = "simulate " + scene_ + " --quiet ";
  for (const std::string& output : {scene_, folder_ / "link.toml", folder_ / "hard.toml",
                                    folder_ / "sub/../in.toml", folder_ / "./in.toml"}) {
    for (const char* option : {"--take ", "--json ", "--trace ", "--events "})
      expect_refused(simulate + option + output, scene_);
  }
  expect_refused("check " + scene_ + " --json " + scene_, scene_);
  expect_refused("render " + scene_ + " --quiet -o " + scene_, scene_);
  expect_refused("bench " + scene_ + " --quiet --junit " + scene_, scene_);
  const std::string fracture = "fracture " + mesh_ + " --pattern voronoi:4 --quiet ";
  expect_refused(fracture + "--json " + mesh_, mesh_);
  expect_refused(fracture + "-o " + folder_.path().string() + "/", mesh_);
  fs::copy_file(mesh_, folder_ / "in.glb");
  expect_refused(
      "fracture " + (folder_ / "in.glb") + " --pattern grid:2 -o " + (folder_ / "in.glb"),
      folder_ / "in.glb");
}

TEST_F(Outputs, ThatAreTheRecordingToVerifyAreRefused) {
  const std::string recording = folder_ / "k.take";
  ASSERT_EQ(sunder("simulate " + scene_ + " --quiet --take " + recording).exit_code, 0);
  expect_refused("simulate " + scene_ + " --quiet --verify " + recording + " --take " + recording,
                 recording);
  EXPECT_EQ(sunder("simulate " + scene_ + " --quiet --verify " + recording).exit_code, 0);
}

TEST_F(Outputs, WithOneNameAreRefused) {
  const std::string file = folder_ / "x";
  expect_refused("simulate " + scene_ + " --quiet --take " + file + " --json " + file, scene_);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(sunder("simulate " + scene_ + " --quiet --trace /dev/null --json /dev/null").exit_code,
            0);
}

TEST_F(Outputs, ThatAreDevicesStayDevices) {
  for (const char* option : {"--json ", "--trace ", "--events "}) {
    const Outcome outcome = sunder("simulate " + scene_ + " --quiet " + option + "/dev/full");
    EXPECT_EQ(outcome.exit_code, 1) << option;
    EXPECT_NE(outcome.err.find("/dev/full"), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(sunder("fracture " + mesh_ + " --pattern grid:2 --quiet --json /dev/null").exit_code,
            0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Outputs, ReachTheReaderOfAPipe) {
  const std::string pipe = folder_ / "pipe", copy = folder_ / "copy.json";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const Outcome outcome = sunder("simulate " + scene_ + " --quiet --json " + pipe,
                                 "timeout 60 cat " + pipe + " > " + copy + " &");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::is_fifo(pipe));
  for (int i = 0; i < 100 && !bytes_of(copy).ends_with("}\n"); ++i) ::usleep(50000);
  EXPECT_NE(bytes_of(copy).find("state_hash"), std::string::npos);
}

TEST_F(Outputs, FollowLinks) {
  const std::string link = folder_ / "link.json", place = folder_ / "place.json";
  fs::create_symlink("place.json", link);  // to a file that does not exist yet
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(sunder("simulate " + scene_ + " --quiet --json " + link).exit_code, 0);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_NE(bytes_of(place).find("state_hash"), std::string::npos);
  }
}

TEST_F(Outputs, AreNotWrittenIfAnOptionIsNotAValidNumber) {
  const std::string fracture = "fracture " + mesh_ + " --pattern voronoi:4 --quiet ";
  const std::string out = folder_ / "x.glb";
  for (const std::string& option :
       {"--explode nan -o " + out, "--explode inf -o " + out, "--radius nan" + std::string(),
        "--radius inf" + std::string(), "--radius 0" + std::string(), "--seed 1e24" + std::string(),
        "--seed -1" + std::string(), "--seed 1.5" + std::string(), "--threads nan" + std::string(),
        "--threads 1e1" + std::string(), "--at nan,0,0" + std::string()}) {
    const Outcome outcome = sunder(fracture + option);
    EXPECT_EQ(outcome.exit_code, 2) << option << outcome.err;
    EXPECT_LT(outcome.err.size(), 250u) << outcome.err;
    EXPECT_FALSE(fs::exists(out)) << option;
  }
  for (const char* speed : {"nan", "inf", "-nan", "0", "1e9"}) {
    const Outcome outcome =
        sunder("render " + scene_ + " --quiet -o " + (folder_ / "x.png") + " --speed " + speed);
    EXPECT_EQ(outcome.exit_code, 2) << speed;
  }
}

}  // namespace
}  // namespace sunder::tests::outputs_program_test
