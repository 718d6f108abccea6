// Tests that wrong input is refused with exit code 2 and a helpful message, and leaves no files.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

namespace fs = std::filesystem;

class WrongInput : public ::testing::Test {
 protected:
  WrongInput() {
    std::ofstream(folder_ / "a.toml") << kBlock;
    std::ofstream(folder_ / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                        "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::ofstream(folder_ / "empty");
    std::ofstream(folder_ / "noise.take") << "not a recording";
    std::ofstream(folder_ / "noise.glb") << "not a mesh";
    fs::create_directory(folder_ / "d");
  }
  std::size_t files() const {
    const fs::recursive_directory_iterator all(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
  Outcome run(const std::string& arguments) {
    return sunder(arguments, "cd " + folder_.path().string() + "; ");
  }
  void expect(const std::string& arguments, const std::string& said) {
    const std::size_t before = files();
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(files(), before) << arguments << " left something behind";
  }

  static constexpr const char* kBlock =
      "[scene]\ndescription = \"a block\"\nduration_s = 0.2\n"
      "[[solid]]\nstructure = \"box\"\nsize_m = [1, 1, 1]\n";
  Folder folder_;
};

TEST_F(WrongInput, IsNamed) {
  const std::pair<const char*, const char*> lines[] = {
      {"simulat a.toml", "did you mean 'simulate'?"},
      {"Simulate a.toml", "did you mean 'simulate'?"},
      {"", "commands: list, check"},
      {"golden tes", "did you mean 'test'?"},
      {"golden", "commands: test, report"},
      {"simulate a.toml --framse 3", "did you mean '--frames'?"},
      {"hull t.obj --vertiices=8", "did you mean '--vertices'?"},
      {"simulate", "SCENE is required"},
      {"simulate a.toml --resume noise.take", "excludes"},
      {"simulate --resume noise.take", "no saved state"},
      {"simulate --resume nothing", "cannot be read"},
      {"simulate --resume noise.take --preset draft", "excludes"},
      {"simulate a.toml --save-at 9 x.state", "expected a time of the run"},
      {"simulate a.toml --save-at nan x.state", "expected a time of the run"},
      {"simulate d", "is a folder"},
      {"simulate nope.toml", "no such file"},
      {"simulate hous", "did you mean 'house'?"},
      {"simulate empty", "is empty"},
      {"simulate a.toml --preset fast", "draft"},
      {"simulate a.toml --frames 0", "from 1 to"},
      {"simulate a.toml --frames 1e3", "a whole number"},
      {"simulate a.toml --frames 500", "ends with frame 12"},
      {"simulate a.toml --threads -1", "from 0 to 1024"},
      {"simulate a.toml --set accuracy.dt_s=nan", "dt_s"},
      {"simulate a.toml --set accuracy.dt_s=0.01", "1/120"},
      {"simulate a.toml --set accuracy.substeps=0", "substeps"},
      {"simulate a.toml --set scene.sede=1", "did you mean 'seed'?"},
      {"simulate a.toml --set scene.seed=-1", "seed"},
      {"simulate a.toml --set limits.bodies=-5", "bodies"},
      {"simulate a.toml --set limits", "key=value"},
      {"simulate a.toml --set solid.0.size_m=[1,-1,1]",
       "size_m in [[solid]] box is [1, -1, 1], in which the number -1 is wrong"},
      {"simulate a.toml --set solid.9.name=x", "9"},
      {"simulate a.toml --json d", "is a folder"},
      {"simulate a.toml --take d", "is a folder"},
      {"simulate a.toml --verify noise.take", "not a recording"},
      {"simulate a.toml --verify nope.take", "nope.take"},
      {"render a.toml -o x.xyz", "x.xyz"},
      {"render a.toml -o x.png --size 100", "WIDTHxHEIGHT"},
      {"render a.toml -o x.png --size 1e3x1e3", "WIDTHxHEIGHT"},
      {"render a.toml -o x.png --speed nan", "from 0.001 to 1000"},
      {"render a.toml -o x.png --fps 0", "from 1 to 1000"},
      {"render a.toml -o x.png --view nowhere", "nowhere"},
      {"render a.toml -o x.png --view nope.toml", "nope.toml"},
      {"render a.toml -o x.png --frames 5:2", "A <= B"},
      {"render a.toml -o x.png --frames 99", "ends with frame"},
      {"render a.toml -o x.png --view-mode pretty", "pretty"},
      {"render a.toml -o x.png --gl vulkan", "vulkan"},
      {"render noise.take -o x.png", "not a recording"},
      {"render a.toml -o x.mp4 --size 101x101", "even"},
      {"fracture t.obj", "--pattern is missing"},
      {"fracture nope.obj --pattern voronoi:5", "nope.obj"},
      {"fracture noise.glb --pattern voronoi:5", "noise.glb"},
      {"fracture d --pattern voronoi:5", "d"},
      {"fracture t.obj --pattern voronoi:0", "from 1 to 5000"},
      {"fracture t.obj --pattern voronoi:nan", "voronoi:N"},
      {"fracture t.obj --pattern circles:3", "voronoi:N"},
      {"fracture t.obj --pattern grid:1000", "from 1 to 30"},
      {"fracture t.obj --pattern brick:0,1,1", "brick"},
      {"fracture t.obj --pattern voronoi:5 --at 1,2", "three numbers"},
      {"fracture t.obj --pattern voronoi:5 --radius -1", "from 1e-09"},
      {"fracture t.obj --pattern voronoi:5 -o x.stl", "X.glb"},
      {"fracture t.obj --pattern voronoi:5 --nodes nope.txt", "nope.txt"},
      {"fracture t.obj --pattern voronoi:5 --fit round", "round"},
      {"fracture t.obj --pattern voronoi:5 --repair maybe", "maybe"},
      {"fracture t.obj --pattern voronoi:5 --convexes 0", "from 1 to"},
      {"fracture hall:100000 --pattern voronoi:5", "5,000"},
      {"fracture voronoi:999999999 --pattern voronoi:5", "100,000"},
      {"fracture grid:1000,1000,1000 --pattern voronoi:5", "1,000,000"},
      {"fracture box:nan,1,1 --pattern voronoi:5", "not a built-in solid"},
      {"fracture torus:1,2 --pattern voronoi:5", "r < R"},
      {"fracture statue:-5 --pattern voronoi:5", "statue"},
      {"vacd nope.obj", "nope.obj"},
      {"hull t.obj --vertices 3", "from 4 to"},
      {"hull t.obj --vertices nan", "a whole number"},
      {"bench nope", "nope"},
      {"bench a.toml --repeats 0", "from 1 to 1000"},
      {"bench a.toml --compare nope.json", "nope.json"},
      {"bench a.toml --against nope", "not a program"},
      {"bench a.toml --fail-slower 10%", "needs --against"},
      {"trade a.toml --seeds 0", "from 1 to 10000"},
      {"trade a.toml --shard 3/2", "3/2"},
      {"trade a.toml --list --switch =1", "KEY=VALUE"},
      {"trade a.toml -o out --set scene.seed=x", "its own seed"},
      {"golden test nope", "tests/golden: no goldens"},
      {"golden test nope --folder " SUNDER_ROOT "/tests/golden", "nope: no such golden"},
      {"check nope.toml a.toml", "nope.toml"}};
  for (const auto& [arguments, said] : lines) expect(arguments, said);
}

TEST_F(WrongInput, OfASceneNamesTheKeyThatWasMeant) {
  std::ofstream(folder_ / "b.toml") << "[scene]\ndescription = \"x\"\n[[solid]]\n"
                                       "structur = \"box\"\nsize_m = [1, 1, 1]\n";
  expect("check b.toml",
         "b.toml:4: missing key 'structure' in [[solid]]; did you misspell it as 'structur'?");
}

TEST_F(WrongInput, OfARecordingNamesWhereItEnds) {
  ASSERT_EQ(run("simulate a.toml --quiet --take k.take").exit_code, 0);
  fs::resize_file(folder_ / "k.take", 100);
  expect("render k.take -o x.png", "before the first frame");
}

TEST_F(WrongInput, ThatCanBeRunGivesAWarning) {
  std::ofstream(folder_ / "none.toml") << "[scene]\ndescription = \"x\"\nduration_s = 0.1\n";
  EXPECT_NE(
      run("simulate none.toml --quiet")
          .err.find(
              "the scene is empty: it has no [[solid]], [[body]], [[ball]] or [[script.shot]]"),
      std::string::npos);
  std::ofstream(folder_ / "under.toml") << kBlock << "position = [0, -5, 0]\n";
  EXPECT_NE(run("check under.toml").err.find("below the ground; raise position"),
            std::string::npos);
  EXPECT_EQ(run("check a.toml").err, "");
  std::ofstream(folder_ / "shot.toml") << kBlock << "anchored = \"bottom\"\n[[script.shot]]\n"
                                       << "time_s = 0.02\nfrom = [0, 0.5, 4]\nat = [0, 0.5, 0]\n"
                                       << "speed_m_s = 60\n[limits]\nbodies = 2\n";
  for (const char* command : {"simulate shot.toml", "render shot.toml --size 32x32 -o shot.png"}) {
    const Outcome outcome = run(command + std::string(" --quiet"));
    EXPECT_NE(outcome.err.find("raise limits.bodies"), std::string::npos) << command;
  }
  EXPECT_NE(run("simulate a.toml --quiet --threads 1000").err.find("which is slower"),
            std::string::npos);
}

}  // namespace
}  // namespace sunder::tests
