// Tests of messages that help: all mistakes of a scene file at once, shots that hit nothing, names
// of scenes, endings in upper case, and pictures that are missing.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "tests/scenes/program.h"

namespace sunder::tests::kind_test {
namespace {

constexpr const char* kBlock =
    "[scene]\ndescription = \"x\"\nduration_s = 2\n"
    "[[solid]]\nstructure = \"box\"\nsize_m = [1, 1, 1]\nanchored = \"bottom\"\n";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string file_of(const Folder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
  return folder / name;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST(Mistakes, AreAllReported) {
  const Folder folder;
  const std::string file =
      file_of(folder, "bad.toml",
              "[scene]\ndescription = \"x\"\ngravitation = 1\n"       // 3
              "[ground]\nfriction = -1\nrestitution = \"high\"\n"     // 5, 6
              "[nothing]\n"                                           // 7
              "[[material]]\nname = \"mud\"\ndensity_kg_m3 = true\n"  // 10
              "[[solid]]\nstructure = \"box\"\nmaterial = \"mud\"\n"
              "size_m = [1, 1]\nposition = 3\nvelocty = [0, 0, 0]\n"  // 14 to 16
              "[[ball]]\nradius_m = -2\n"                             // 18
              "[[script.shot]]\ntime_s = 0\nform = [0, 0, 0]\n"       // 21
              "[[script.blast]]\ntime_s = 0\nat = [0, 0]\n");         // 24
  const Outcome outcome = sunder("check " + file);
  EXPECT_EQ(outcome.exit_code, 2);
  for (const int line : {3, 5, 6, 7, 10, 14, 15, 16, 18, 21, 24}) {
    EXPECT_TRUE(has(outcome.err, "bad.toml:" + std::to_string(line) + ":"))
        << "line " << line << " in\n"
        << outcome.err;
  }
  EXPECT_FALSE(has(outcome.err, "unknown material")) << "mud is known, if wrong: " << outcome.err;
  EXPECT_EQ(lines(outcome.err), 12u) << outcome.err;  // line 21: unknown form, and missing from
}

TEST(Mistakes, ThatFollowFromOthersAreLeftOut) {
  const Folder folder;
  const std::string file =
      file_of(folder, "bad.toml",
              std::string(kBlock) +
                  "name = \"block\"\nsize = 2\n"
                  "[[ball]]\nname = \"ball\"\n"
                  "[[joint]]\nkind = \"ball\"\na = \"block\"\nb = \"ball\"\nat = [0, 1, 0]\n"
                  "[[script.remove]]\ntime_s = 1\nname = \"block\"\n");
  const Outcome outcome = sunder("check " + file);
  EXPECT_EQ(lines(outcome.err), 1u) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "unknown key 'size'")) << outcome.err;
}

TEST(Run, SaysWhichShotHitNothing) {
  const Folder folder;
  const std::string shot = "[[script.shot]]\ntime_s = 0.1\nspeed_m_s = 40\n";
  const std::string file =
      file_of(folder, "miss.toml",
              kBlock + shot + "from = [0, 9, 10]\nat = [0, 9, 0]\n" + shot +
                  "name = \"low\"\nfrom = [5, 0.6, 4]\nat = [5, 0, 0]\n" + shot +
                  "name = \"good\"\nradius_m = 0.2\nfrom = [0, 0.5, 10]\nat = [0, 0.7, 0]\n");
  const Outcome outcome = sunder("simulate " + file + " --frames 30");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(has(outcome.out, "shot 'shot.0' at 0.1 s hit nothing")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "shot 'low' at 0.1 s hit the ground before")) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "good")) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "nothing broke")) << outcome.out;
  EXPECT_EQ(sunder("simulate " + file + " --frames 30 --quiet").out, "");
}

TEST(Run, SaysThatNothingBroke) {
  EXPECT_TRUE(has(sunder("simulate stack --frames 3").out, "nothing broke\n"));
  const Folder folder;
  const std::string picture = folder / "x.PNG";
  EXPECT_TRUE(
      has(sunder("render stack --frames 0:3 --size 64x48 -o " + picture).out, "nothing broke\n"));
  EXPECT_TRUE(std::filesystem::is_regular_file(picture));
}

TEST(List, PrintsNamesAlone) {
  std::istringstream out(sunder("list --quiet").out);
  std::size_t count = 0;
  for (std::string name; std::getline(out, name); ++count)
    EXPECT_EQ(scenes::scene_file(name).stem().string(), name);
  EXPECT_EQ(count, scenes::catalog().size());
}

TEST(Endings, MayBeInUpperCase) {
  const Folder folder;
  const std::string scene = file_of(folder, "SCENE.TOML", kBlock);
  EXPECT_EQ(sunder("check " + scene).exit_code, 0);
  EXPECT_TRUE(has(sunder("check " + (folder / "NONE.TOML")).err, "cannot be read"));
  const std::string pieces = folder / "PIECES.GLB";
  EXPECT_EQ(sunder("fracture box:1,1,1 --pattern grid:2 -o " + pieces).exit_code, 0);
  EXPECT_EQ(sunder("vacd " + pieces + " --nodes 2").exit_code, 0);
  const std::string mesh =
      file_of(folder, "TETRA.OBJ",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_EQ(sunder("hull " + mesh + " --vertices 4").exit_code, 0);
  const std::string take = folder / "RUN.TAKE";
  ASSERT_EQ(sunder("simulate stack --frames 2 --take " + take).exit_code, 0);
  EXPECT_EQ(sunder("render " + take + " --size 64x48 -o " + (folder / "y.PNG")).exit_code, 0);
}

TEST(Pictures, ThatAreMissingAreNamedInAWarning) {
  const Folder folder;
  file_of(folder, "m.mtl", "newmtl wood\nmap_Kd planks.png\n");
  const std::string mesh = file_of(folder, "m.obj",
                                   "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
                                   "usemtl wood\nf 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\n"
                                   "f 2/1 3/1 4/1\n");
  const std::string scene =
      file_of(folder, "s.toml", "[scene]\ndescription = \"x\"\n[[body]]\nmesh = \"m.obj\"\n");
  const std::string output = " -o " + (folder / "x.png");
  for (const std::string& command :
       {"check " + scene, "simulate " + scene + " --frames 1", "vacd " + mesh + output,
        "fracture " + mesh + " --pattern grid:2" + output}) {
    const Outcome outcome = sunder(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << outcome.err;
    EXPECT_TRUE(has(outcome.err, "warning: ") && has(outcome.err, "planks.png"))
        << command << ": " << outcome.err;
  }
}

}  // namespace
}  // namespace sunder::tests::kind_test
