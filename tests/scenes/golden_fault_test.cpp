// Tests that goldens find faults and attribute them to the drawing or the simulation. Faults are
// put into the parts of a golden: its stored frame, its baseline, and the setup of its scene.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/frame_file.h"
#include "render/image/image.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using render::Image;
const fs::path kGoldens = fs::path(SUNDER_ROOT) / "tests/golden";

/// A copy of a golden under another name in a folder, for tests to change.
class Copy {
 public:
  Copy(const Folder& folder, const std::string& golden, const std::string& name,
       const fs::path& from = kGoldens)
      : folder_(folder), name_(name) {
    for (const char* extension : {".frame", ".view", ".png", ".json"}) {
      const fs::path original = from / (golden + extension);
      if (fs::exists(original)) fs::copy(original, file(extension));
    }
    std::ifstream hashes(from / "hashes.txt");
    std::ofstream copy(folder / "hashes.txt", std::ios::app);
    for (std::string line; std::getline(hashes, line);) {
      for (const std::string kind : {"frames/", "seconds/"}) {
        const std::string of_golden = kind + golden + "/";
        if (line.starts_with(of_golden))
          copy << kind << name << "/" << line.substr(of_golden.size()) << "\n";
      }
    }
  }

  void change_frame(const std::function<void(Frame&)>& change) const {
    Frame frame = *read_frame(file(".frame"));
    change(frame);
    write_frame(file(".frame"), frame);
  }
  void change_picture(const std::function<Image(const Image&)>& change) const {
    render::write_png(file(".png"), change(render::read_png(file(".png"))));
  }
  /// Sets keys of the scene, as --set does.
  void change_scene(const std::vector<std::string>& set) const {
    edit([&](Json& recipe) { recipe["set"] = set; });
  }
  /// Appends text to the scene's file.
  void add_to_scene(const std::string& text) const {
    edit([&](Json& recipe) {
      const fs::path scene = scenes::scene_file(recipe["scene"]);
      std::ofstream(folder_ / (name_ + ".toml")) << scenes::read_text(scene) << text;
      recipe["scene"] = name_ + ".toml";
    });
  }

 private:
  std::string file(const char* extension) const { return folder_ / (name_ + extension); }
  void edit(const std::function<void(Json&)>& change) const {
    Json recipe = Json::parse(scenes::read_text(file(".json")));
    change(recipe);
    std::ofstream(file(".json")) << recipe;
  }

  const Folder& folder_;
  std::string name_;
};

/// Returns the texts of the failed verdicts, by golden and by the subject of the verdict.
std::map<std::string, std::map<std::string, std::string>> failures_in(const Folder& folder) {
  const Outcome outcome = sunder("golden test --json - --folder " + folder.path().string() +
                                 " --out " + folder / "out");
  EXPECT_LE(outcome.exit_code, 1) << outcome.err;
  std::map<std::string, std::map<std::string, std::string>> failures;
  const Json results = Json::parse(outcome.out);
  for (const Json& golden : results["goldens"]) {
    auto& of_golden = failures[golden["name"]];
    for (const Json& verdict : golden["verdicts"]) {
      if (!verdict["passed"]) of_golden[verdict["what"]] = verdict["text"];
    }
  }
  return failures;
}

/// Adds an invisible piece with wrong, huge bounds: the shadow map that has to cover it has no
/// texel left for other pieces.
void lose_shadows(Frame& frame) {
  Mesh mesh = *(*frame.meshes)[frame.instances.front().mesh.value];
  mesh.vertices.resize(3);
  for (Mesh::Vertex& v : mesh.vertices) v.position = Vec3f(1e5f, 0, 0);
  mesh.vertices.front().position = Vec3f(-1e5f, 0, 0);
  mesh.indices = {0, 1, 2};
  MeshStore meshes = *frame.meshes;
  meshes.push_back(std::make_shared<const Mesh>(mesh));
  frame.instances.push_back({MeshIndex(meshes.size() - 1), frame.instances.front().body});
  frame.meshes = std::make_shared<const MeshStore>(std::move(meshes));
}

void swap_materials(Frame& frame) {
  std::vector<Material> materials = *frame.materials;
  std::vector<std::size_t> used;
  for (const Instance& instance : frame.instances) {
    used.push_back((*frame.meshes)[instance.mesh.value]->material.value);
  }
  const auto other = std::ranges::find_if(used, [&](std::size_t m) { return m != used.front(); });
  std::swap(materials[used.front()], materials[other == used.end() ? 0 : *other]);
  frame.materials = std::make_shared<const std::vector<Material>>(std::move(materials));
}

/// Removes the piece with the largest apparent size. Static bodies, such as walls, are not removed.
void lose_piece(Frame& frame) {
  const auto apparent_size = [&](const Instance& instance) {
    const FrameBody& body = frame.bodies[instance.body];
    if (body.is_static) return 0.0;
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    double radius = 0;
    for (const Mesh::Vertex& v : mesh.vertices) {
      radius =
          std::max(radius, static_cast<double>((v.position - mesh.vertices[0].position).norm()));
    }
    const Vec3 at_W = body.X_WB * (mesh.X_RT * mesh.origin_T - body.com_R);
    return radius / (at_W - frame.view.eye_W).norm();
  };
  const auto largest = std::ranges::max_element(frame.instances, {}, apparent_size);
  frame.instances.erase(largest);
}

Image shifted(const Image& image) {
  Image moved = image;
  std::copy(image.rgb.begin(), image.rgb.end() - 3, moved.rgb.begin() + 3);
  return moved;
}

Image brighter(const Image& image) {
  Image bright = image;
  for (std::uint8_t& level : bright.rgb) {
    level = static_cast<std::uint8_t>(std::min(255.0, std::round(1.02 * level)));
  }
  return bright;
}

/// Returns every material of the library, one per cent denser, as TOML.
std::string heavier_materials() {
  std::string text;
  for (const Material& material : scenes::builtin_materials()) {
    text += "\n[[material]]\nname = \"" + material.name +
            "\"\ndensity_kg_m3 = " + std::to_string(1.01 * material.density_kg_m3) + "\n";
  }
  return text;
}

std::vector<std::string> of_shots(const std::string& golden, const std::string& assignment) {
  std::vector<std::string> set;
  const Json recipe = Json::parse(scenes::read_text(kGoldens / (golden + ".json")));
  const std::string text = scenes::read_text(scenes::scene_file(recipe["scene"]));
  for (std::size_t at = 0; (at = text.find("[[script.shot]]", at)) != std::string::npos; ++at) {
    set.push_back("script.shot." + std::to_string(set.size()) + "." + assignment);
  }
  return set;
}

TEST(GoldenFaults, EveryFaultInTheDrawingIsFoundAndAttributedToIt) {
  const Folder folder;
  const std::string golden = "column_row";
  const Copy none(folder, golden, "none");
  Copy(folder, golden, "no_shadow").change_frame(lose_shadows);
  Copy(folder, golden, "no_dust").change_frame([](Frame& frame) { frame.dust.clear(); });
  Copy(folder, golden, "no_debris").change_frame([](Frame& frame) { frame.debris.clear(); });
  Copy(folder, golden, "other_material").change_frame(swap_materials);
  Copy(folder, golden, "no_piece").change_frame(lose_piece);
  Copy(folder, golden, "shifted").change_picture(shifted);
  Copy(folder, golden, "brighter").change_picture(brighter);
  const auto failures = failures_in(folder);
  EXPECT_EQ(failures.size(), 8u);
  for (const auto& [fault, failed] : failures) {
    EXPECT_EQ(failed.contains("drawing"), fault != "none") << fault;
    for (const auto& [what, text] : failed)
      EXPECT_FALSE(what.starts_with("simulation")) << fault << ": " << what << " " << text;
  }
}

TEST(GoldenFaults, EveryFaultInTheSimulationIsFoundAndAttributedToIt) {
  const Folder folder;
  const std::string golden = "column_row";
  const double next_to_z = std::nextafter(8.0, 9.0);
  std::ostringstream one_bit_off;
  one_bit_off.precision(17);
  one_bit_off << "from=[-3.4,1.6," << next_to_z << "]";
  Copy(folder, golden, "gravity").change_scene({"scene.gravity=[0,-9.9081,0]"});
  Copy(folder, golden, "density").add_to_scene(heavier_materials());
  Copy(folder, golden, "slow_shots").change_scene(of_shots(golden, "speed_m_s=1"));
  Copy(folder, golden, "one_bit").change_scene({"script.shot.0." + one_bit_off.str()});
  const auto failures = failures_in(folder);
  EXPECT_EQ(failures.size(), 4u);
  // Gravity and density differ at once; the first shot comes at 0.3 s, in frame 18 or 19.
  for (const auto& [fault, failed] : failures) {
    EXPECT_FALSE(failed.contains("drawing")) << fault;
    const bool by_shot = fault == "slow_shots" || fault == "one_bit";
    for (const char* preset : {"draft", "realtime", "accurate", "reference"}) {
      const auto at = failed.find(std::string("simulation at ") + preset);
      ASSERT_NE(at, failed.end()) << fault;
      int frame = -1;
      ASSERT_EQ(std::sscanf(at->second.c_str(), "differs from frame %d on", &frame), 1)
          << at->second;
      EXPECT_EQ(frame / 2, by_shot ? 9 : 0) << fault << " at " << preset << ": " << at->second;
    }
  }
}

TEST(GoldenFaults, ADifferentCameraOrColorsOfTheSceneAreFoundAndNamed) {
  const Folder folder;
  const std::string golden = "column_row";
  Copy(folder, golden, "none").change_scene({});
  Copy(folder, golden, "eye").change_scene({"view.eye=[1,2,9]", "view.sun_strength=2"});
  Copy(folder, golden, "color")
      .add_to_scene(
          "\n[[material]]\nname = \"foundation\"\nsurface = { color = [0.1, 0.2, 0.9] }\n");
  Copy(folder, "brick_wall", "bricks").change_scene({"solid.0.second_share=0"});
  const auto failures = failures_in(folder);
  const auto view = [&](const std::string& name) {
    const auto& failed = failures.at(name);
    const auto at = failed.find("view");
    return at == failed.end() ? "" : at->second;
  };
  EXPECT_EQ(view("none"), "");
  EXPECT_NE(view("eye").find("view.eye, view.sun_strength"), std::string::npos) << view("eye");
  EXPECT_NE(view("color").find("colours of foundation"), std::string::npos) << view("color");
  EXPECT_NE(view("bricks").find("material of brick_wall."), std::string::npos) << view("bricks");
  for (const char* fault : {"eye", "color"}) EXPECT_EQ(failures.at(fault).size(), 1u) << fault;
}

TEST(GoldenFaults, WithoutAFrameADifferentPictureIsAttributedToItsCause) {
  const Folder made, folder;
  const std::string at = " --folder " + made.path().string();
  ASSERT_EQ(sunder("golden record box stack 20 --no-frame --size 160x90" + at).exit_code, 0);
  ASSERT_EQ(sunder("golden accept box" + at).exit_code, 0);
  const auto copy = [&](const char* name) { return Copy(folder, "box", name, made.path()); };
  copy("none").change_scene({});
  copy("brighter").change_picture(brighter);
  copy("rising").change_scene({"scene.gravity=[0,9.81,0]"});
  copy("eye").change_scene({"view.eye=[1,2,9]"});
  const std::string unjudged = "is not judged, because no frame is stored and the ";
  const auto failures = failures_in(folder);
  EXPECT_TRUE(failures.at("none").empty());
  EXPECT_EQ(failures.at("brighter").size(), 1u);
  EXPECT_TRUE(failures.at("brighter").at("drawing").starts_with("differs: "));
  EXPECT_EQ(failures.at("rising").size(), 5u) << "the drawing, and the simulation at each preset";
  EXPECT_EQ(failures.at("rising").at("drawing"), unjudged + "simulation differs");
  EXPECT_EQ(failures.at("eye").size(), 2u);
  EXPECT_EQ(failures.at("eye").at("drawing"), unjudged + "view differs");
  EXPECT_NE(failures.at("eye").at("view").find("view.eye"), std::string::npos);
}

// Twenty runs: threads of the simulation by threads of the rasteriser, in both kinds of contexts.
TEST(GoldenFaults, NoNumberOfThreadsAndNoContextGivesAFalseFailure) {
  struct Drawn {
    const char* gl;
    int threads;
  };
  Json first;
  int runs = 0;
  for (const Drawn& drawn : {Drawn{"egl-surfaceless", 1}, Drawn{"egl-surfaceless", 4},
                             Drawn{"osmesa", 2}, Drawn{"osmesa", 4}}) {
    for (const int threads : {1, 2, 3, 4, 7}) {
      const Outcome outcome =
          sunder("golden test column_row glass_near --folder " + kGoldens.string() +
                     " --json - --gl " + drawn.gl + " --threads " + std::to_string(threads),
                 "LP_NUM_THREADS=" + std::to_string(drawn.threads) + " ");
      if (outcome.exit_code == 2) break;  // there is no such context here
      EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
      Json results = Json::parse(outcome.out);
      for (Json& golden : results["goldens"]) golden.erase("renderer");
      if (runs++ == 0) first = results;
      EXPECT_EQ(results, first) << drawn.gl << ", " << drawn.threads << " by " << threads;
    }
  }
  EXPECT_GE(runs, 10);
}

TEST(GoldenFaults, OfTwoFaultsBothAreNamed) {
  const Folder folder;
  const Copy both(folder, "glass", "both");
  both.change_picture(brighter);
  both.change_scene(of_shots("glass", "speed_m_s=1"));
  const auto failures = failures_in(folder);
  EXPECT_EQ(failures.at("both").size(), 6u)
      << "the drawing, the simulation at each preset, and that to its end";
}

}  // namespace
}  // namespace sunder::tests
