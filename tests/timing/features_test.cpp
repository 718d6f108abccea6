// Tests of the features that a run models.
#include "scenes/features.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/io/state_hash.h"
#include "engine/io/statistics.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

std::string state(const Scene& scene, const char* name) { return find_feature(name)->state(scene); }

Scene of(const std::string& text) {
  return parse_scene("[scene]\ndescription = \"x\"\nduration_s = 1\n" + text, "x.toml");
}

TEST(Features, EachIsOnOrOffOrOffForAReasonInEveryScene) {
  std::set<std::string> on, off;
  for (const char* name : {"house", "glass", "stack", "planar_wall", "wrecking_ball", "vase"}) {
    const RunInfo info = run_info(load_scene(name));
    EXPECT_EQ(info.modelled.size(), features().size());
    for (const auto& [feature, state] : info.modelled) {
      (state == "on" ? on : off).insert(feature);
      EXPECT_TRUE(state == "on" || state == "off" ||
                  (state.starts_with("off: ") && state.size() > 10))
          << feature << ": " << state;
    }
  }
  for (const char* feature : {"fracture", "impact_probe", "stress", "debris", "dust", "joints",
                              "sleeping", "continuous_collision", "visual_meshes", "script"}) {
    EXPECT_TRUE(on.contains(feature)) << feature;
    EXPECT_TRUE(off.contains(feature) || feature == std::string("sleeping")) << feature;
  }
}

TEST(Features, AreOffAfterTurnOff) {
  for (const char* name : {"house", "glass", "wrecking_ball", "steel_hall"}) {
    for (const Feature& feature : features()) {
      Scene scene = load_scene(name);
      if (!feature.turn_off || feature.state(scene) != "on") continue;
      feature.turn_off(scene);
      EXPECT_TRUE(feature.state(scene).starts_with("off")) << name << ", " << feature.name;
    }
  }
}

TEST(Features, AreOnWhereTheSceneSaysSo) {
  const Scene plain = of("[[ball]]\nposition = [0, 5, 0]\n");
  EXPECT_EQ(state(plain, "fracture"), "off: no material of a solid has a fracture pattern");
  EXPECT_EQ(state(plain, "debris"), "off: no solid is breakable");
  EXPECT_TRUE(state(plain, "restitution").starts_with("off: "));
  EXPECT_TRUE(state(plain, "rolling_resistance").starts_with("off: "));
  EXPECT_EQ(
      state(of("[ground]\nrestitution = 0.5\n[[ball]]\nposition = [0, 5, 0]\n"), "restitution"),
      "on");
  EXPECT_EQ(state(of("[[material]]\nname = \"rubber\"\nrolling = 0.1\n[[ball]]\nmaterial = "
                     "\"rubber\"\nposition = [0, 5, 0]\n"),
                  "rolling_resistance"),
            "on");
  EXPECT_TRUE(
      state(of("[[material]]\nname = \"rubber\"\nrolling = 0.1\n[[ball]]\nposition = [0, 5, "
               "0]\n"),
            "rolling_resistance")
          .starts_with("off: "))
      << "no body has this material";
  EXPECT_EQ(state(load_scene("house", {"realtime", {"limits.dust=0"}}), "dust"),
            "off: dust = 0 in [limits]");
  EXPECT_EQ(state(load_scene("house", {"realtime", {"limits.ageing=500"}}), "ageing"), "on");
  EXPECT_EQ(state(load_scene("house", {"reference", {}}), "conjugate_gradients"), "on");
  EXPECT_EQ(find_feature("no such thing"), nullptr);
}

/// Returns the hash of the states of the first 30 frames.
std::string state_of_run(const Scene& scene) {
  constexpr int kFrames = 30;
  const auto simulation = make_simulation(scene);
  StateHash hash;
  for (int i = 0; i <= kFrames; ++i) hash.take(simulation->next());
  return hash.hex(kFrames);
}

TEST(Features, UnusedByASceneDoNotChangeItsState) {
  // Scenes of separate bodies at rest: no breaks, no debris, no joints.
  for (const char* name : {"stack", "brick_wall", "dominoes"}) {
    const Scene scene = load_scene(name, {"draft", {"script.enabled=false"}});
    const std::string as_it_is = state_of_run(scene);
    Scene more = scene;
    more.limits.ageing = more.limits.bodies;
    more.limits.debris += 1000, more.limits.dust += 1000;
    EXPECT_EQ(state_of_run(more), as_it_is) << name << " with ageing, debris and dust";
    for (const char* feature :
         {"fracture", "stress", "yielding", "debris", "dust", "ageing", "joints"}) {
      Scene less = scene;
      if (find_feature(feature)->state(less) != "on") continue;
      find_feature(feature)->turn_off(less);
      EXPECT_EQ(state_of_run(less), as_it_is) << name << " without " << feature;
    }
  }
}

TEST(Features, WithoutSleepingNoBodySleeps) {
  for (const char* planar : {"", "planar = true\n"}) {
    Scene scene = of(std::string(planar) + "[[ball]]\nposition = [0, 0.5, 0]\n");
    scene.duration_s = 3;
    for (const bool sleeping : {true, false}) {
      scene.solver.sleeping = sleeping;
      const auto simulation = make_simulation(scene);
      FramePtr last;
      while (FramePtr frame = simulation->next()) last = frame;
      EXPECT_EQ(last->report.counts.awake, sleeping ? 0u : 1u) << planar;
    }
  }
}

}  // namespace
}  // namespace sunder::scenes
