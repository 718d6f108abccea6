// Tests that scenes/README.md agrees with the tables of the reader.
#include <algorithm>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "engine/model/frame.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

TEST(ScenesReadme, ListsEveryKeyWithUnitDefaultAndRange) {
  const std::string readme = read_text(SUNDER_ROOT "/scenes/README.md");
  EXPECT_NE(readme.find(key_reference()), std::string::npos)
      << "scenes/README.md is out of date: replace its reference by the output of\n"
         "  build/sunder list --keys";
}

TEST(JsonPage, ListsEveryLimit) {
  const std::string page = read_text(SUNDER_ROOT "/docs/json.md");
  std::string table;
  for (const LimitText& text : kLimitTexts)
    table += std::string("| `") + text.name + "` | " + text.counted + " | " + text.advice +
             (text.by_design ? " (by design: not warned of)" : "") + " |\n";
  EXPECT_NE(page.find(table), std::string::npos) << "the table of limits should be:\n" << table;
}

TEST(ScenesReadme, NamesEveryScene) {
  const std::string readme = read_text(SUNDER_ROOT "/scenes/README.md");
  for (const CatalogEntry& entry : catalog()) {
    EXPECT_NE(readme.find("`" + entry.name + "`"), std::string::npos) << entry.name;
  }
}

/// Returns the blocks of TOML in a section, joined in order.
std::string toml_of_section(const std::string& heading) {
  std::istringstream readme(read_text(SUNDER_ROOT "/scenes/README.md"));
  std::string toml, line;
  bool in_section = false, in_block = false;
  while (std::getline(readme, line)) {
    if (line.starts_with("## ")) in_section = line == "## " + heading;
    if (!in_section) continue;
    if (line.starts_with("```")) {
      in_block = line == "```toml";
    } else if (in_block) {
      toml += line + "\n";
    }
  }
  return toml;
}

/// Returns the largest height of a mesh origin after `frames`, without balls, and all breaks so
/// far.
std::pair<double, std::size_t> height_and_breaks(Scene scene, int frames) {
  const auto simulation = make_simulation(std::move(scene));
  FramePtr frame;
  std::size_t breaks = 0;
  for (int i = 0; i <= frames; ++i) {
    frame = simulation->next();
    breaks += frame->breaks.size();
  }
  double high_m = 0;
  for (const Instance& instance : frame->instances) {
    const FrameBody& body = frame->bodies[instance.body];
    const Vec3 origin_R = (*frame->meshes)[instance.mesh.value]->origin_T;
    if (body.com_R.isZero()) continue;  // a ball
    high_m = std::max(high_m, (body.X_WB * (origin_R - body.com_R)).y());
  }
  return {high_m, breaks};
}

TEST(ScenesReadme, TheStrangersBuildingStandsAndFallsWhenShot) {
  const std::string toml = toml_of_section("A stranger's building");
  const Scene scene = parse_scene(toml, "gate.toml", {"draft", {}});
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_EQ(scene.solids[0].name, "gate");
  const Scene quiet =
      parse_scene(toml, "gate.toml", {"draft", {"script.enabled=false", "scene.duration_s=60"}});
  const auto [high_m, breaks] = height_and_breaks(quiet, 3600);
  EXPECT_EQ(breaks, 0u);
  EXPECT_GT(high_m, 4.1);
  const auto [low_m, breaks_by_shot] = height_and_breaks(scene, 240);
  EXPECT_GT(breaks_by_shot, 0u);
  EXPECT_LT(low_m, 0.7 * high_m);
}

}  // namespace
}  // namespace sunder::scenes
