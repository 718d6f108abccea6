// Tests of goldens: stored frames and their scenes give the stored pictures and states, and the
// comparison tells different pictures apart.
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/frame_file.h"
#include "render/image/compare.h"
#include "scenes/file/text_file.h"
#include "tests/engine/markup.h"
#include "tests/scenes/program.h"

namespace sunder::tests::golden_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
const fs::path kGoldens = fs::path(SUNDER_ROOT) / "tests/golden";

/// Returns the files of goldens with this extension, sorted, without originals.
std::vector<fs::path> goldens(const std::string& extension) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(kGoldens)) {
    const bool is_original = entry.path().string().ends_with(".original.png");
    if (entry.path().extension() == extension && !is_original) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// Copies all files of a golden.
void copy_golden(const std::string& name, const Folder& folder) {
  for (const char* extension : {".frame", ".png", ".json"}) {
    fs::copy(kGoldens / (name + extension), folder.path());
  }
  fs::copy(kGoldens / "hashes.txt", folder.path());
}

// Takes half a minute on two processors.
TEST(Golden, DrawingAndSimulationAreUnchanged) {
  const Folder folder;
  const Outcome outcome =
      sunder("golden test --folder " + kGoldens.string() + " --out " + folder / "out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(Golden, EveryPairOfDifferentBaselinesIsToldApart) {
  std::vector<render::Image> pictures;
  const std::vector<fs::path> files = goldens(".png");
  for (const fs::path& file : files) pictures.push_back(render::read_png(file));
  EXPECT_GE(pictures.size(), 20u);
  for (std::size_t a = 0; a < files.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      const bool same = render::compare(pictures[a], pictures[b]).passes(render::Thresholds());
      EXPECT_EQ(same, a == b) << files[a] << " against " << files[b];
    }
  }
}

TEST(Golden, EveryTextureAndEveryPassIsInAGolden) {
  std::set<Texture> textures;
  std::size_t debris = 0, dust = 0;
  for (const fs::path& file : goldens(".frame")) {
    const FramePtr frame = read_frame(file);
    frame->meshes->for_each([&](std::size_t i) {
      const Material& material = (*frame->materials)[(*frame->meshes)[i]->material.value];
      textures.insert({material.surface.texture, material.interior.texture});
    });
    debris += frame->debris.size();
    dust += frame->dust.size();
  }
  for (const Texture texture : {Texture::kBrick, Texture::kConcrete, Texture::kPlaster,
                                Texture::kWood, Texture::kGlass, Texture::kMetal}) {
    EXPECT_TRUE(textures.contains(texture)) << static_cast<int>(texture);
  }
  EXPECT_GT(debris, 1000u);
  EXPECT_GT(dust, 100u);
  std::set<std::string> view_modes, layers, others;
  int whole_runs = 0;
  for (const fs::path& file : goldens(".json")) {
    const Json recipe = Json::parse(scenes::read_text(file));
    view_modes.insert(recipe["view_mode"]);
    layers.insert(recipe.value("layer", ""));
    if (recipe["hud"].get<bool>()) others.insert("hud");
    if (recipe.value("transparent", false)) others.insert("transparent");
    if (recipe.value("speed", 1.0) != 1) others.insert("speed");
    if (recipe.value("samples", 1) > 1 && recipe["scene"] == "column_row.frame")
      others.insert("samples of a frame with dust");
    if (recipe.value("set", Json()).dump().find("view.shutter") != std::string::npos)
      others.insert("shutter");
    whole_runs += recipe.value("to_the_end", false);
  }
  EXPECT_EQ(view_modes.size(), 10u);
  EXPECT_EQ(layers, (std::set<std::string>{"", "depth", "depth_m", "normals", "ids"}));
  EXPECT_EQ(others.size(), 5u);
  EXPECT_GE(whole_runs, 6);
}

TEST(Golden, StoredFramesAreSmall) {
  std::uintmax_t bytes = 0;
  for (const char* extension : {".frame", ".view"}) {
    for (const fs::path& file : goldens(extension)) bytes += fs::file_size(file);
  }
  EXPECT_LE(bytes, 4'000'000u) << "record large frames by `sunder golden record --no-frame`";
}

TEST(Golden, HashesAreOfEveryPresetOfEverySimulatedGoldenAndOfNoOther) {
  std::set<std::string> expected, found;
  for (const fs::path& file : goldens(".json")) {
    const Json recipe = Json::parse(scenes::read_text(file));
    if (recipe["scene"].get<std::string>().ends_with(".frame")) continue;
    if (recipe.value("to_the_end", false))
      expected.insert("seconds/" + file.stem().string() + "/realtime");
    for (const char* preset : {"draft", "realtime", "accurate", "reference"}) {
      expected.insert("frames/" + file.stem().string() + "/" + preset);
    }
  }
  std::ifstream hashes(kGoldens / "hashes.txt");
  for (std::string line; std::getline(hashes, line);) {
    if (line.starts_with("frames/") || line.starts_with("seconds/"))
      found.insert(line.substr(0, line.find(' ')));
  }
  EXPECT_EQ(found, expected);
}

TEST(Golden, TheReportedCommandsMakeTheSameGoldenAgain) {
  const Folder first, second;
  const std::string record =
      "golden record box stack 3 --preset draft --set limits.dust=7 "
      "--set scene.gravity=[0,-5,0] --size 64x48 --hud --folder ";
  ASSERT_EQ(sunder(record + first.path().string()).exit_code, 0);
  ASSERT_EQ(sunder("golden record above " + first / "box.frame" +
                   " --set view.eye=[1,20,1] --view-mode compounds --size 64x48 --folder " +
                   first.path().string())
                .exit_code,
            0);
  ASSERT_EQ(
      sunder("golden record bare stack 3 --no-frame --size 64x48 --folder " + first.path().string())
          .exit_code,
      0);
  ASSERT_EQ(sunder("golden record film stack 5 --speed 0.3 --samples 2 --set view.shutter=0.5 "
                   "--no-frame --to-the-end --size 64x48 --folder " +
                   first.path().string())
                .exit_code,
            0);
  ASSERT_EQ(sunder("golden record clear " + first / "box.frame" +
                   " --transparent --samples 3 --size 64x48 --folder " + first.path().string())
                .exit_code,
            0);
  ASSERT_EQ(sunder("golden record layer " + first / "box.frame" +
                   " --layer normals --size 64x48 --folder " + first.path().string())
                .exit_code,
            0);
  const std::string names = "box above bare film clear layer";
  ASSERT_EQ(sunder("golden accept " + names + " --folder " + first.path().string()).exit_code, 0);
  const Outcome outcome = sunder("golden test --json - --folder " + first.path().string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json results = Json::parse(outcome.out);
  fs::copy(first.path(), second.path());
  for (const Json& golden : results["goldens"]) {
    const std::string commands = golden["remade_by"];
    for (const char* extension : {".json", ".png", ".frame", ".view"}) {
      fs::remove(first / (golden["name"].get<std::string>() + extension));
    }
    const std::size_t both = commands.find(" && sunder ");
    ASSERT_EQ(commands.find("sunder "), 0u);
    ASSERT_NE(both, std::string::npos) << commands;
    EXPECT_EQ(sunder(commands.substr(7, both - 7)).exit_code, 0) << commands;
    EXPECT_EQ(sunder(commands.substr(both + 11)).exit_code, 0) << commands;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(second.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(scenes::read_text(first / name), scenes::read_text(entry.path())) << name;
  }
}

TEST(Golden, AMissingBaselineFailsUntilItIsAccepted) {
  const Folder folder;
  for (const char* extension : {".frame", ".json"}) {
    const fs::path file =
        fs::path(SUNDER_ROOT) / "tests/golden" / (std::string("glass") + extension);
    fs::copy(file, folder.path());
  }
  const std::string at = " --folder " + folder.path().string() + " --out " + folder / "out";
  const Outcome missing = sunder("golden test glass" + at);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.out.find("no baseline"), std::string::npos) << missing.out;
  const std::string accept = "golden accept glass --folder " + folder.path().string();
  const Outcome refused = sunder(accept);
  EXPECT_EQ(refused.exit_code, 1) << "a deleted picture is no way around its original";
  EXPECT_NE(refused.out.find("glass.png is missing"), std::string::npos) << refused.out;
  EXPECT_FALSE(fs::exists(folder / "glass.png"));
  EXPECT_EQ(sunder(accept + " --rebase ' '").exit_code, 2) << "no reason";
  EXPECT_EQ(sunder(accept + " --rebase 'the picture was lost'").exit_code, 0);
  EXPECT_EQ(sunder("golden test glass" + at).exit_code, 0);
  EXPECT_EQ(sunder("golden report glass" + at).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}

TEST(Golden, AWrongPictureFailsAndTheSimulationDoesNot) {
  const Folder folder;
  copy_golden("glass", folder);
  fs::copy(kGoldens / "house.png", folder / "glass.png", fs::copy_options::overwrite_existing);
  const Outcome outcome = sunder("golden report --folder " + folder.path().string() + " --out " +
                                 folder / "out" + " --junit " + folder / "junit.xml");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("FAIL glass: drawing differs: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("; simulation same\n"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(folder / "out/glass.png"));
  const std::string page = scenes::read_text(folder / "out/report.html");
  EXPECT_EQ(markup_mistake(page), "");
  EXPECT_NE(page.find("simulation at reference"), std::string::npos);
  const std::string xml = scenes::read_text(folder / "junit.xml");
  EXPECT_NE(xml.find("tests=\"7\" failures=\"1\""), std::string::npos) << xml;
}

TEST(Golden, AcceptingTheSimulationLeavesTheDrawingAndOtherHashes) {
  const Folder folder;
  copy_golden("stack", folder);
  const std::string hashes = folder / "hashes.txt";
  const std::string right = scenes::read_text(hashes);
  std::string wrong = right;
  const std::size_t line = wrong.find("frames/stack/draft");
  char& digit = wrong[wrong.find('\n', line) - 1];
  digit = digit == '0' ? '1' : '0';
  std::ofstream(hashes) << wrong;
  const std::string recipe = scenes::read_text(folder / "stack.json");
  const std::string at = " --folder " + folder.path().string();
  const Outcome failed = sunder("golden test" + at);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_NE(failed.out.find("drawing same; simulation at draft differs from frame 60 on"),
            std::string::npos)
      << failed.out;
  EXPECT_EQ(sunder("golden accept stack" + at).exit_code, 0);
  EXPECT_EQ(scenes::read_text(hashes), right);
  EXPECT_EQ(scenes::read_text(folder / "stack.json"), recipe);
}

TEST(Golden, AcceptingAnotherCameraRecordsTheFrameAgain) {
  const Folder folder;
  copy_golden("stack", folder);
  Json recipe = Json::parse(scenes::read_text(folder / "stack.json"));
  recipe["set"] = {"view.fov_deg=30"};
  std::ofstream(folder / "stack.json") << recipe;
  const std::string at = " --folder " + folder.path().string();
  const std::string test = "golden test --out " + folder / "out" + at;
  const Outcome failed = sunder(test);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_NE(failed.out.find("FAIL stack: drawing same; view of the scene differs"),
            std::string::npos)
      << failed.out;
  EXPECT_NE(failed.out.find("view.fov_deg"), std::string::npos) << failed.out;
  const std::string before = scenes::read_text(folder / "stack.frame");
  EXPECT_EQ(sunder("golden accept stack" + at).exit_code, 1) << "another camera is another picture";
  EXPECT_EQ(scenes::read_text(folder / "stack.frame"), before) << "nothing is stored";
  const Outcome accepted = sunder("golden accept stack --rebase nearer" + at);
  EXPECT_NE(accepted.out.find("new frame, simulation unchanged"), std::string::npos)
      << accepted.out;
  EXPECT_EQ(read_frame(folder / "stack.frame")->view.fov_rad, 30 * std::numbers::pi / 180);
  EXPECT_EQ(sunder(test).exit_code, 0);
}

TEST(Golden, AcceptingWithoutAFrameAcceptsPictureViewAndSimulation) {
  const Folder folder;
  const std::string at = " --folder " + folder.path().string();
  const std::string record = "golden record box stack 20 --size 160x90" + at;
  ASSERT_EQ(sunder(record).exit_code, 0);
  ASSERT_EQ(sunder(record + " --no-frame").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "box.frame")) << "it is replaced";
  ASSERT_EQ(sunder("golden accept box" + at).exit_code, 0);
  EXPECT_LT(fs::file_size(folder / "box.view"), 1000u);
  Json recipe = Json::parse(scenes::read_text(folder / "box.json"));
  recipe["set"] = {"scene.gravity=[0,9.81,0]", "view.fov_deg=30"};
  std::ofstream(folder / "box.json") << recipe;
  const Outcome accepted = sunder("golden accept box --rebase 'it rises'" + at);
  EXPECT_NE(accepted.out.find("\naccepted box: drawing "), std::string::npos) << accepted.out;
  EXPECT_NE(accepted.out.find(", new view, new simulation"), std::string::npos) << accepted.out;
  EXPECT_FALSE(fs::exists(folder / "box.frame"));
  EXPECT_EQ(sunder("golden test" + at).exit_code, 0);
}

// Ten changes of 0.05 % in brightness, each of which is within the thresholds of a comparison.
TEST(Golden, TinyChangesAreAcceptedUntilTheirSumIsTooFarFromTheOriginal) {
  const Folder folder;
  const std::string at = " --folder " + folder.path().string();
  ASSERT_EQ(sunder("golden record box stack 3 --size 160x90" + at).exit_code, 0);
  ASSERT_EQ(sunder("golden accept box" + at).exit_code, 0);
  const std::string picture = folder / "box.png", original = folder / "box.original.png";
  const render::Image first = render::read_png(picture);
  const auto set_exposure = [&](int step) {
    Json recipe = Json::parse(scenes::read_text(folder / "box.json"));
    recipe["set"] = {"view.exposure=" + std::to_string(1 + 0.0005 * step)};
    std::ofstream(folder / "box.json") << recipe;
  };
  int step = 1;
  Outcome outcome;
  for (; step <= 10; ++step) {
    const render::Image last = render::read_png(picture);
    set_exposure(step);
    outcome = sunder("golden accept box" + at);
    const render::Image now = render::read_png(picture);
    EXPECT_TRUE(render::compare(first, now).passes({})) << outcome.out;
    EXPECT_TRUE(render::compare(last, now).passes({}));
    if (outcome.exit_code != 0) {
      EXPECT_EQ(now, last) << "a refused picture is not stored";
      break;
    }
    EXPECT_NE(outcome.out.find(" from the original FLIP mean "), std::string::npos) << outcome.out;
    EXPECT_EQ(render::read_png(original), first);
  }
  EXPECT_GT(step, 2) << "the first changes are small";
  ASSERT_LE(step, 10) << "the sum of ten is not";
  EXPECT_EQ(outcome.exit_code, 1);
  const std::string after_folder = outcome.out.substr(outcome.out.find('\n') + 1);
  EXPECT_EQ(after_folder.rfind("refused box: the picture is too far from the original", 0), 0u)
      << outcome.out;
  EXPECT_NE(outcome.out.find("accept box --rebase"), std::string::npos) << outcome.out;

  set_exposure(step - 1);
  const std::string out = " --out " + folder / "out";
  const Json crept = Json::parse(sunder("golden test --json -" + at + out).out);
  EXPECT_EQ(crept["farthest_from_original"], Json({"box"}));
  EXPECT_GT(crept["goldens"][0]["original"]["flip_mean"], 0.0);
  EXPECT_EQ(crept["goldens"][0]["same_bytes"], true);
  EXPECT_EQ(sunder("golden report" + at + out).exit_code, 0);
  const std::string page = scenes::read_text(folder / "out/report.html");
  EXPECT_NE(page.find("Distance from the originals"), std::string::npos);
  EXPECT_EQ(markup_mistake(page), "");

  set_exposure(step);
  EXPECT_EQ(sunder("golden accept box --rebase 'a brighter sky'" + at).exit_code, 0);
  EXPECT_FALSE(render::compare(first, render::read_png(picture)).passes({}))
      << "what was refused is over the thresholds";
  EXPECT_FALSE(fs::exists(original));
  const Json rebased = Json::parse(sunder("golden test --json -" + at + out).out);
  EXPECT_EQ(rebased["farthest_from_original"], Json::array());
  EXPECT_EQ(rebased["goldens"][0]["original"]["rebased"], "a brighter sky");
}

TEST(Golden, APictureThatWasReplacedByHandIsNotTakenForTheAcceptedOne) {
  const Folder folder;
  const std::string at = " --folder " + folder.path().string();
  ASSERT_EQ(sunder("golden record box stack 3 --size 160x90" + at).exit_code, 0);
  ASSERT_EQ(sunder("golden accept box" + at).exit_code, 0);
  render::Image image = render::read_png(folder / "box.png");
  image.rgb[0] ^= 1;
  render::write_png(folder / "box.png", image);
  const Outcome outcome = sunder("golden test --out " + folder / "out" + at);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("box.png is not the picture that was accepted"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(sunder("golden accept box" + at).exit_code, 1);
}

TEST(Golden, ARecordedFilmIsThePictureThatRenderDraws) {
  const Folder folder;
  const std::string looks = " --samples 3 --set view.shutter=1 --speed 0.7 --size 96x54";
  ASSERT_EQ(sunder("golden record film glass 25 --no-frame" + looks + " --folder " +
                   folder.path().string())
                .exit_code,
            0);
  ASSERT_EQ(sunder("golden accept film --folder " + folder.path().string()).exit_code, 0);
  ASSERT_EQ(sunder("render glass --frames 15:19" + looks + " -o " + folder / "pictures/").exit_code,
            0);
  EXPECT_EQ(render::read_png(folder / "film.png"),
            render::read_png(folder / "pictures/frame_00025.png"));
}

TEST(Golden, AStateThatDiffersInALateSecondIsFound) {
  const Folder folder;
  const std::string at = " --folder " + folder.path().string();
  ASSERT_EQ(sunder("golden record box stack 3 --to-the-end --size 64x48" + at).exit_code, 0);
  ASSERT_EQ(sunder("golden accept box" + at).exit_code, 0);
  const std::string hashes = folder / "hashes.txt";
  std::string text = scenes::read_text(hashes);
  const std::size_t line = text.find("seconds/box/realtime");
  ASSERT_NE(line, std::string::npos) << text;
  // Ten seconds and one frame are stored; the tenth of them is changed.
  char& digit = text[text.find('\n', line) - 5];
  digit = digit == '0' ? '1' : '0';
  std::ofstream(hashes) << text;
  const Outcome differs = sunder("golden test" + at);
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_NE(differs.out.find("simulation to its end at realtime differs from second 9 on (frame "
                             "540)"),
            std::string::npos)
      << differs.out;
  text.erase(line, text.find('\n', line) + 1 - line);
  std::ofstream(hashes) << text;
  const Outcome missing = sunder("golden test" + at);
  EXPECT_NE(missing.out.find("simulation to its end at realtime has no stored states in "),
            std::string::npos)
      << missing.out;
  EXPECT_EQ(sunder("golden accept box" + at).exit_code, 0);
  EXPECT_EQ(sunder("golden test" + at).exit_code, 0);
}

TEST(Golden, ABaselineOfAnotherSizeIsNamedAsThat) {
  const Folder folder;
  copy_golden("glass", folder);
  render::write_png(folder / "glass.png", {64, 36, std::vector<std::uint8_t>(64 * 36 * 3)});
  const Outcome outcome =
      sunder("golden test --folder " + folder.path().string() + " --out " + folder / "out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("has another size: 64x36, the picture 640x360"), std::string::npos)
      << outcome.out;
}

TEST(Golden, OfTheWorkingDirectoryAreTestedAndAcceptedByWhateverProgramRunsThere) {
  const Folder folder, elsewhere;
  const fs::path own = folder.path() / "tests/golden";
  fs::create_directories(own);
  for (const char* extension : {".frame", ".png", ".json"})
    fs::copy(kGoldens / (std::string("glass") + extension), own);
  fs::copy(kGoldens / "house.png", own / "glass.png", fs::copy_options::overwrite_existing);
  const std::string enter = "cd " + folder.path().string() + " && ";
  const std::string copy = elsewhere / "sunder";
  fs::copy_file(SUNDER_PROGRAM, copy);
  const std::string text = elsewhere / "text";
  const auto run = [&](const std::string& program, const std::string& arguments) {
    const int status =
        std::system((enter + program + " " + arguments + " >" + text + " 2>&1").c_str());
    return std::pair(WEXITSTATUS(status), scenes::read_text(text));
  };
  const std::string of = "goldens of " + fs::canonical(own).string() + "\n";
  for (const std::string& program : {std::string("\"" SUNDER_PROGRAM "\""), copy}) {
    const auto [code, out] = run(program, "golden test glass");
    EXPECT_EQ(code, 1) << out;
    EXPECT_TRUE(out.starts_with(of)) << out;
    EXPECT_NE(out.find("FAIL glass: drawing differs"), std::string::npos) << out;
    const auto [bench_code, bench_out] = run(program, "bench --from nowhere.json");
    EXPECT_EQ(bench_code, 2);
    EXPECT_NE(
        bench_out.find("no stored states in " + fs::canonical(own).string() + "/hashes.txt\n"),
        std::string::npos)
        << bench_out;
  }
  const std::string before = scenes::read_text(kGoldens / "glass.png");
  const auto [code, out] =
      run("\"" SUNDER_PROGRAM "\"", "golden accept glass --rebase 'the first one'");
  EXPECT_EQ(code, 0) << out;
  EXPECT_TRUE(out.starts_with(of)) << out;
  EXPECT_EQ(run(copy, "golden test glass").first, 0);
  EXPECT_EQ(scenes::read_text(kGoldens / "glass.png"), before);
  EXPECT_NE(scenes::read_text(own / "hashes.txt"), "");
}

TEST(Golden, AWorkingDirectoryWithoutAnyIsRefusedByName) {
  const Folder folder;
  for (const std::string& command :
       {std::string("test glass"), std::string("test"), std::string("accept glass")}) {
    const Outcome outcome = sunder("golden " + command, "cd " + folder.path().string() + " && ");
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_NE(outcome.err.find(fs::canonical(folder.path()).string() +
                               "/tests/golden: no goldens (NAME.json) in this folder; give their "
                               "folder by --folder"),
              std::string::npos)
        << outcome.err;
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Golden, AFileWithAWrongSizeOrUnclosedBracketsIsRefused) {
  const Folder folder;
  copy_golden("glass", folder);
  Json recipe = Json::parse(scenes::read_text(folder / "glass.json"));
  const std::string lists(1 << 20, '[');
  const auto changed = [&](const char* key, const Json& value) {
    Json other = recipe;
    other[key] = value;
    return other.dump();
  };
  for (const auto& [text, place] :
       std::vector<std::pair<std::string, std::string>>{{changed("width", -5), "/width"},
                                                        {changed("width", 2000000000), "/width"},
                                                        {changed("samples", 0), "/samples"},
                                                        {changed("speed", -1), "/speed"},
                                                        {changed("speed", "fast"), "/speed"},
                                                        {changed("layer", 3), "/layer"},
                                                        {changed("layer", "fog"), "fog"},
                                                        {changed("to_the_end", 1), "/to_the_end"},
                                                        {lists, ""}}) {
    std::ofstream(folder / "glass.json") << text;
    const Outcome outcome = sunder("golden test --folder " + folder.path().string());
    EXPECT_EQ(outcome.exit_code, 2) << text.substr(0, 40);
    EXPECT_NE(outcome.err.find(place), std::string::npos) << outcome.err;
  }
}

TEST(Golden, RecordAcceptsAFrameOfASceneOrAStoredFrameOnly) {
  const Folder folder;
  copy_golden("stack", folder);
  const std::string at = " --folder " + folder.path().string();
  for (const std::string& wrong : std::vector<std::string>{
           "x stack", "x " + folder / "stack.frame" + " 3", "x stack 3 --size 5", "x stack 100000",
           "x nowhere.frame", "x stack 3 --speed 0.5", "x stack 3 --layer fog",
           "x stack 3 --layer ids --hud", "x stack 3 --samples 2 --set view.shutter=1",
           "x " + folder / "stack.frame" + " --to-the-end", "x stack 599 --speed 2 --no-frame",
           "x stack 3 --no-frame --view-mode contacts",
           "x " + folder / "stack.frame" + " --no-frame", "'x y' stack 3", "../x stack 3",
           "x " + folder / "stack.frame" + " --set scene.gravity=[0,0,0]"}) {
    const Outcome outcome = sunder("golden record " + wrong + at);
    EXPECT_EQ(outcome.exit_code, 2) << wrong;
    EXPECT_FALSE(fs::exists(folder / "x.json")) << wrong;
  }
}

}  // namespace
}  // namespace sunder::tests::golden_test
