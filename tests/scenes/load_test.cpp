// Tests of the scenes that valid scene files become.
#include "scenes/load.h"

#include <numbers>

#include <gtest/gtest.h>

#include "engine/base/check.h"

namespace sunder::scenes::load_test {
namespace {

Scene scene_of(const std::string& lines, const LoadOptions& options = {}) {
  return parse_scene("[scene]\ndescription = \"x\"\n" + lines, "folder/name.toml", options);
}

const Material& material(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials) {
    if (m.name == name) return m;
  }
  throw std::runtime_error("no material " + name);
}

TEST(Load, NamesTheSceneAfterItsFile) { EXPECT_EQ(scene_of("").name, "name"); }

TEST(Load, KeepsTheDefaultsOfTheWorld) {
  const Scene scene = scene_of("");
  const Scene fresh;
  EXPECT_EQ(scene.duration_s, fresh.duration_s);
  EXPECT_EQ(scene.gravity_W, fresh.gravity_W);
  EXPECT_EQ(scene.limits.bodies, fresh.limits.bodies);
  EXPECT_EQ(scene.ground.friction, fresh.ground.friction);
}

TEST(Load, TurnsDegreesIntoRadians) {
  EXPECT_DOUBLE_EQ(scene_of("[view]\nfov_deg = 90\n").view.fov_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(scene_of("[view]\nfov_rad = 0.5\n").view.fov_rad, 0.5);
}

TEST(Load, PresetsSetTheStepAndTheFileOverridesThem) {
  EXPECT_DOUBLE_EQ(scene_of("", {"draft", {}}).accuracy.dt_s, 1.0 / 60);
  EXPECT_DOUBLE_EQ(scene_of("", {"realtime", {}}).accuracy.dt_s, 1.0 / 120);
  const Scene scene = scene_of("[accuracy]\ndt_s = 0.004166667\nsubsteps = 8\n");
  EXPECT_EQ(scene.accuracy.dt_s, 1.0 / 60 / 4);
  EXPECT_EQ(scene.accuracy.substeps, 8);
}

TEST(Load, AMaterialStartsFromItsNamesakeOrFromAnother) {
  const Scene scene = scene_of(
      "[[material]]\nname = \"brick\"\ntoughness_J_m2 = 7\n"
      "[[material]]\nname = \"tile\"\nlike = \"glass\"\npattern = { rings = 3 }\n");
  EXPECT_EQ(material(scene, "brick").toughness_J_m2, 7);
  EXPECT_EQ(material(scene, "brick").density_kg_m3, 1900);
  EXPECT_EQ(material(scene, "tile").density_kg_m3, material(scene, "glass").density_kg_m3);
  EXPECT_EQ(material(scene, "tile").pattern.rings, 3);
  EXPECT_EQ(material(scene, "tile").pattern.spokes, material(scene, "glass").pattern.spokes);
  EXPECT_EQ(material(scene, "tile").pattern.kind, PatternSpec::Kind::kWeb);
}

TEST(Load, PlacesSolidsByTheirFootAndTurnsThem) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"box\"\nsize_m = [2, 1, 4]\nposition = [10, 0, 0]\n"
      "rotation_deg = [0, 90, 0]\n");
  ASSERT_EQ(scene.solids.size(), 1u);
  const Vec3 corner_W = scene.solids[0].X_WR * Vec3(1, 1, 2);
  EXPECT_NEAR((corner_W - Vec3(12, 1, -1)).norm(), 0, 1e-12);
}

TEST(Load, AnAnchoredSolidStandsOnAnAnchoredFoundation) {
  const std::string box = "[[solid]]\nstructure = \"box\"\n";
  EXPECT_FALSE(scene_of(box).solids[0].compound.is_anchored());
  const Scene scene = scene_of(box + "anchored = \"bottom\"\n");
  const Compound& compound = scene.solids[0].compound;
  EXPECT_TRUE(compound.is_anchored());
  ASSERT_EQ(compound.bonds.size(), 1u);
  EXPECT_NEAR(compound.bonds[0].area_m2, 1, 1e-12);
  EXPECT_LT(bounds(compound).min.y(), 0) << "the foundation is in the ground";
}

TEST(Load, UnnamedObjectsGetUniqueNames) {
  const std::string pane = "[[solid]]\nstructure = \"pane\"\n";
  const std::string box = "[[body]]\nmesh = \"box:1,1,1\"\n";
  const Scene scene = scene_of(pane + pane + pane + "name = \"pane 2\"\n" + box + box);
  std::vector<std::string> names;
  for (const Solid& solid : scene.solids) names.push_back(solid.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"pane", "pane 3", "pane 2", "box:1,1,1", "box:1,1,1 2"}));
}

TEST(Load, AGivenNameIsNotUsedForUnnamedObjects) {
  const Scene scene = scene_of(
      "[[solid]]\nstructure = \"box\"\n[[ball]]\nname = \"box\"\n"
      "[[solid]]\nstructure = \"stack\"\ncount = 2\n[[solid]]\nstructure = \"stack\"\ncount = 2\n");
  std::vector<std::string> names;
  for (const Solid& solid : scene.solids) names.push_back(solid.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"box 2", "stack.0", "stack.1", "stack 2.0", "stack 2.1"}));
}

TEST(Load, BuiltinMaterialsAreAvailableToScenesMadeInCode) {
  Scene scene;
  scene.materials = builtin_materials();
  const Scene loaded = scene_of("");
  ASSERT_EQ(scene.materials.size(), loaded.materials.size());
  EXPECT_EQ(scene.materials[material_named(scene, "steel").value].name, "steel");
  try {
    material_named(scene, "stel");
    ADD_FAILURE() << "there is no such material";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("the scene: unknown material 'stel'; did you mean 'steel'?"))
        << error.what();
  }
}

TEST(Load, ShotsAreInOrderOfTimeAndAimed) {
  const Scene scene = scene_of(
      "[script]\n[[script.shot]]\ntime_s = 2\nfrom = [0, 0, 0]\nvelocity = [1, 2, 3]\n"
      "[[script.shot]]\ntime_s = 1\nfrom = [0, 0, 0]\nat = [0, 0, -5]\nspeed_m_s = 30\n");
  ASSERT_EQ(scene.shots.size(), 2u);
  EXPECT_EQ(scene.shots[0].time_s, 1);
  EXPECT_EQ(scene.shots[0].ball.velocity_W, Vec3(0, 0, -30));
  EXPECT_EQ(scene.shots[1].ball.velocity_W, Vec3(1, 2, 3));
}

TEST(Load, ActionsOfEveryKindAreInOrderOfTime) {
  const auto twice = [](const std::string& header, const std::string& keys) {
    return header + "\ntime_s = 2\n" + keys + header + "\ntime_s = 1\n" + keys;
  };
  const Scene scene = scene_of(
      "[[ball]]\nname = \"x\"\n" +
      twice("[[script.shot]]", "from = [0, 0, 0]\nvelocity = [1, 0, 0]\n") +
      twice("[[script.blast]]", "at = [0, 1, 0]\n") + twice("[[script.remove]]", "name = \"x\"\n") +
      twice("[[script.drive]]", "name = \"x\"\nvelocity = [1, 0, 0]\n"));
  const auto expect_sorted = [](const auto& actions) {
    ASSERT_EQ(actions.size(), 2u);
    EXPECT_EQ(actions[0].time_s, 1);
    EXPECT_EQ(actions[1].time_s, 2);
  };
  expect_sorted(scene.shots);
  expect_sorted(scene.blasts);
  expect_sorted(scene.removals);
  expect_sorted(scene.drives);
}

TEST(Load, FlagsChangeGivenKeysAndAddOthers) {
  LoadOptions options;
  options.set = {"scene.seed=7", "ground.friction=0.25", "ball.1.position=[1, 2, 3]",
                 "ball.0.material=wood"};
  const Scene scene = scene_of("[[ball]]\n[[ball]]\n", options);
  EXPECT_EQ(scene.seed, 7u);
  EXPECT_EQ(scene.ground.friction, 0.25);
  EXPECT_EQ(scene.balls[1].center_W, Vec3(1, 2, 3));
  EXPECT_EQ(scene.materials[scene.balls[0].material.value].name, "wood");
}

TEST(Load, AScriptCanBeSwitchedOff) {
  const std::string shot = "[[script.shot]]\ntime_s = 2\nfrom = [0, 0, 0]\nvelocity = [1, 2, 3]\n";
  EXPECT_EQ(scene_of(shot).shots.size(), 1u);
  EXPECT_EQ(scene_of(shot, {"realtime", {"script.enabled=false"}}).shots.size(), 0u);
}

TEST(Load, EverySceneOfTheCatalogueLoadsAndHasADescription) {
  const std::vector<CatalogEntry> entries = catalog();
  EXPECT_GE(entries.size(), 5u);
  for (const CatalogEntry& entry : entries) {
    const Scene scene = load_scene(entry.name, {});
    EXPECT_EQ(scene.name, entry.name);
    EXPECT_EQ(scene.description, entry.description);
    EXPECT_FALSE(scene.solids.empty()) << entry.name;
  }
}

}  // namespace
}  // namespace sunder::scenes::load_test
