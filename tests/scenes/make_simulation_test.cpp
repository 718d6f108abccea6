// A scene and its simulation are wired together as the scene says.
#include "scenes/make_simulation.h"

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

constexpr const char* kHead = "[scene]\ndescription = \"x\"\nduration_s = 1\n";

/// The last frame of a scene.
FramePtr end_of(const Scene& scene, const SimulationOptions& options = {}) {
  const auto simulation = make_simulation(scene, options);
  FramePtr last;
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  return last;
}

TEST(MakeSimulation, GivesTheSolverTheScenesGravity) {
  for (const char* planar : {"", "planar = true\n"}) {
    const Scene scene = parse_scene(
        std::string(kHead) + "gravity = [0, -2, 0]\n" + planar + "[[ball]]\nposition = [0, 5, 0]\n",
        "fall.toml");
    const FramePtr last = end_of(scene);
    EXPECT_EQ(last->index, 60u);
    for (const FrameBody& body : last->bodies) {
      if (body.is_static) continue;
      EXPECT_NEAR(body.X_WB.position.y(), 5 - 0.5 * 2, 0.03) << planar;
    }
  }
}

TEST(MakeSimulation, RefusesAPlanarSceneMadeInCodeThatIsNone) {
  Scene scene = parse_scene(std::string(kHead) + "[[ball]]\nposition = [0, 5, 1]\n", "x.toml");
  scene.planar = true;
  EXPECT_THROW(make_simulation(scene), InputError);
}

TEST(MakeSimulation, TellsWhatAPresetIsTooCoarseFor) {
  const Scene scene =
      parse_scene(std::string(kHead) + "[[solid]]\nstructure = \"stack\"\ncount = 200\n",
                  "tower.toml", {"draft", {}});
  std::vector<std::string> told;
  SimulationOptions options;
  options.warn = [&](const std::string& warning) { told.push_back(warning); };
  make_simulation(scene, options);
  ASSERT_EQ(told.size(), run_info(scene, "draft").warnings.size());
  for (const std::string& warning : told) EXPECT_TRUE(warning.starts_with("tower: ")) << warning;
}

}  // namespace
}  // namespace sunder::scenes
