// Tests of the error target in metres, and of warnings where a preset is not accurate enough.
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/model/checks/scene_accuracy.h"
#include "engine/model/checks/scene_chains.h"
#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/file/schema.h"
#include "scenes/load.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::tests {
namespace {

constexpr double kG = 9.81;

/// Returns a stack of unit boxes of 2 kg/m³, with a top box of `top` times the weight of the
/// others.
Scene stack(int count, double top, const std::string& preset, std::vector<std::string> set = {}) {
  std::string text = "[scene]\ndescription = \"x\"\nduration_s = 3\n[accuracy]\n";
  text += "[[material]]\nname = \"light\"\nlike = \"steel\"\ndensity_kg_m3 = 2\n";
  text += "[[material]]\nname = \"heavy\"\nlike = \"steel\"\ndensity_kg_m3 = " +
          std::to_string(2 * top) + "\n";
  text += "[[solid]]\nstructure = \"stack\"\nmaterial = \"light\"\ncount = " +
          std::to_string(count - 1) + "\n";
  text += "[[solid]]\nstructure = \"box\"\nname = \"top\"\nmaterial = \"heavy\"\nposition = [0, " +
          std::to_string(count - 1) + ", 0]\n";
  return scenes::parse_scene(text, "stack.toml", {preset, std::move(set)});
}

std::string warning_of(const Scene& scene) { return accuracy_warning(scene, scenes::kMaxSubsteps); }

double deepest_m(Scene scene) {
  auto physics = solver::make_rigid_physics({});
  Simulation simulation(std::move(scene), std::move(physics), fracture::make_pattern_breaker());
  double deepest = 0;
  while (const FramePtr frame = simulation.next()) {
    deepest = 0;
    for (const float depth : frame->report.penetrations_m)
      deepest = std::max(deepest, double{depth});
  }
  return deepest;
}

TEST(Accuracy, TheLoadOfAStackIsItsWeightInBodies) {
  const Stack even = find_stacks(stack(10, 1, "accurate")).deepest;
  EXPECT_EQ(even.bodies, 10u);
  EXPECT_NEAR(even.load, 10, 1e-9);
  EXPECT_NEAR(even.size_m, 1, 1e-9);
  const Stack heavy = find_stacks(stack(10, 100, "accurate")).deepest;
  EXPECT_NEAR(heavy.load, 109, 1e-9);
}

TEST(Accuracy, AWideWallNeedsFewerSubstepsThanATowerAndTheShippedOneHasThem) {
  const auto tower = [](const char* size) {
    const std::string text =
        "[scene]\ndescription = \"x\"\nduration_s = 3\n[[solid]]\n"
        "structure = \"stack\"\ncount = 20\nsize_m = " +
        std::string(size);
    return find_stacks(scenes::parse_scene(text, "tower.toml", {"realtime", {}})).weakest;
  };
  EXPECT_NEAR(tower("[0.2, 0.2, 0.2]").slenderness_1_m, 100, 1e-6);
  EXPECT_NEAR(tower("[0.4, 0.2, 0.3]").slenderness_1_m, 20 * 0.2 / 0.09, 1e-6);
  EXPECT_EQ(warning_of(scenes::load_scene("brick_wall", {"realtime", {}})), "");
}

TEST(Accuracy, SubstepsFollowFromTheTargetAndItIsMet) {
  for (const int count : {5, 20}) {
    for (const double target : {2e-3, 2e-4}) {
      const Scene scene =
          stack(count, 1, "realtime", {"accuracy.error_target_m=" + std::to_string(target)});
      const int substeps = scene.accuracy.substeps;
      const double reached = deepest_m(scene);
      std::printf("stack of %2d, target %.1e m: %2d substeps, reached %.1e m\n", count, target,
                  substeps, reached);
      EXPECT_EQ(substeps,
                substeps_for_penetration(find_stacks(scene).deepest, kG, 1.0 / 120, target));
      EXPECT_LT(reached, 1.2 * target);
    }
  }
}

TEST(Accuracy, AWarningNamesTheSubstepsThatAreEnough) {
  EXPECT_EQ(warning_of(stack(10, 1, "draft")), "");
  EXPECT_EQ(warning_of(stack(10, 1, "accurate")), "");
  const Scene heavy = stack(10, 10000, "accurate");
  const int needed = substeps_against_buckling(find_stacks(heavy).weakest, kG, heavy.accuracy.dt_s);
  EXPECT_GT(needed, heavy.accuracy.substeps);
  const std::string warning = warning_of(heavy);
  EXPECT_NE(warning.find(std::to_string(needed) + " substeps"), std::string::npos) << warning;
  EXPECT_NE(warning.find("10 bodies"), std::string::npos) << warning;
  const Scene held = stack(10, 10000, "accurate", {"accuracy.substeps=" + std::to_string(needed)});
  EXPECT_EQ(warning_of(held), "");
}

/// Returns stacked boxes of 2 kg/m³, too light to break.
Scene tower(int count, double size_m, const std::string& duration_s, const std::string& preset,
            std::vector<std::string> set = {}) {
  const std::string size = std::to_string(size_m);
  std::string text = "[scene]\ndescription = \"x\"\nduration_s = " + duration_s + "\n";
  text += "[accuracy]\n[[material]]\nname = \"light\"\nlike = \"steel\"\ndensity_kg_m3 = 2\n";
  text +=
      "[[solid]]\nstructure = \"stack\"\nmaterial = \"light\"\ncount = " + std::to_string(count) +
      "\nsize_m = [" + size + ", " + size + ", " + size + "]\n";
  return scenes::parse_scene(text, "tower.toml", {preset, std::move(set)});
}

/// Returns the largest displacement of a body from its start, over `size_m`. Sleeping is off.
double largest_displacement(Scene scene, double size_m) {
  solver::RigidOptions options;
  options.gravity_W = scene.gravity_W;
  options.sleeping = false;
  Simulation simulation(std::move(scene), solver::make_rigid_physics(options),
                        fracture::make_pattern_breaker());
  const FramePtr first = simulation.next();
  double most = 0;
  while (const FramePtr frame = simulation.next()) {
    EXPECT_EQ(frame->bodies.size(), first->bodies.size());
    for (std::size_t i = 0; i < std::min(first->bodies.size(), frame->bodies.size()); ++i)
      most =
          std::max(most, (frame->bodies[i].X_WB.position - first->bodies[i].X_WB.position).norm());
  }
  return most / size_m;
}

/// Returns the settings that the warning names.
std::vector<std::string> settings_of_warning(const Scene& scene) {
  const Accuracy stand = accuracy_against_buckling(scene, scenes::kMaxSubsteps);
  char text[80];
  std::snprintf(text, sizeof text, "%d substeps of dt 1/%.4g s", stand.substeps, 1 / stand.dt_s);
  EXPECT_NE(warning_of(scene).find(text), std::string::npos) << warning_of(scene);
  std::printf("%s: ", text);
  std::snprintf(text, sizeof text, "accuracy.dt_s=%.17g", stand.dt_s);
  return {"accuracy.substeps=" + std::to_string(stand.substeps), text};
}

/// Returns a box of 1 kg under a slab of a million kg.
Scene under_a_million(std::vector<std::string> set = {}) {
  std::string text = "[scene]\ndescription = \"x\"\nduration_s = 3\n[accuracy]\n";
  for (const auto& [name, density] : {std::pair("light", "1"), {"heavy", "30000"}})
    text += std::string("[[material]]\nlike = \"steel\"\nname = \"") + name +
            "\"\ndensity_kg_m3 = " + density + "\n";
  text += "[[solid]]\nstructure = \"box\"\nname = \"low\"\nmaterial = \"light\"\n";
  text +=
      "[[solid]]\nstructure = \"box\"\nname = \"top\"\nmaterial = \"heavy\"\n"
      "size_m = [5, 1.3333, 5]\nposition = [0, 1, 0]\n";
  return scenes::parse_scene(text, "million.toml", {"accurate", std::move(set)});
}

/// Largest displacement with the settings of the preset, and with those that the warning names.
struct Displacements {
  std::vector<std::string> set;  ///< Settings that the warning names.
  double before = 0, then = 0;
};

/// Measures the displacements of the scene that `make` returns for given settings.
template <class Make>
Displacements measure_displacements(const char* what, double size_m, const Make& make) {
  Displacements displacements{settings_of_warning(make(std::vector<std::string>()))};
  displacements.before = largest_displacement(make(std::vector<std::string>()), size_m);
  displacements.then = largest_displacement(make(displacements.set), size_m);
  std::printf("%s: moves by %.2g sides, by %.2g before\n", what, displacements.then,
              displacements.before);
  return displacements;
}

TEST(Accuracy, ATopAMillionTimesAsHeavyStandsWithTheSubstepsThatTheWarningNames) {
  const auto make = [](auto set) { return under_a_million(std::move(set)); };
  const Displacements top = measure_displacements("a top of 1e6 weights", 1, make);
  EXPECT_GT(top.before, 0.1);
  EXPECT_LT(top.then, 0.02);
  EXPECT_EQ(warning_of(under_a_million(top.set)), "");
}

TEST(Accuracy, BodiesTooSmallForTheirSubstepsStandWithThoseThatTheWarningNames) {
  const auto make = [](auto set) { return tower(12, 0.001, "3", "draft", std::move(set)); };
  const Displacements boxes = measure_displacements("12 boxes of a millimetre", 0.001, make);
  EXPECT_GT(boxes.before, 0.1);
  EXPECT_LT(boxes.then, 0.02);
}

TEST(Accuracy, ATowerFallsAwakeBelowTheSubstepsThatTheWarningNamesAndStandsWithThem) {
  const auto make = [](auto set) { return tower(40, 0.1, "30", "accurate", std::move(set)); };
  const Displacements boxes = measure_displacements("tower of 40", 0.1, make);
  EXPECT_GT(boxes.before, 1);
  EXPECT_LT(boxes.then, 0.02);
}

/// Returns a steel ball released on a chain that hangs from 10 m above the ground.
Scene wrecking_ball(const std::string& links, const std::string& preset,
                    std::vector<std::string> set = {}) {
  const std::string text =
      "[scene]\ndescription = \"x\"\nduration_s = 4\n[accuracy]\n"
      "[[material]]\nname = \"steel\"\ntensile_Pa = 0\nshear_Pa = 0\ncompressive_Pa = 0\n"
      "yield_Pa = 0\n"
      "[script]\n[[script.wrecking_ball]]\nname = \"ball\"\nfrom = [-6.4, 7.8, 0]\n"
      "hangs_from = [0, 10, 0]\nradius_m = 0.6\nlinks = " +
      links + "\n";
  return scenes::parse_scene(text, "chain.toml", {preset, std::move(set)});
}

/// Returns the largest elongation of the chain, over its length.
double stretches(Scene scene) {
  Simulation simulation(std::move(scene), solver::make_rigid_physics({}),
                        fracture::make_pattern_breaker());
  const Vec3 chain(-6.4, -2.2, 0), end_R = -0.6 * chain.normalized();
  double worst = -1;
  while (const FramePtr frame = simulation.next()) {
    if (frame->bodies.empty()) continue;
    const Vec3 end_W = frame->bodies.back().X_WB * end_R;
    worst = std::max(worst, (end_W - Vec3(0, 10, 0)).norm() / (chain + end_R).norm() - 1);
  }
  return worst;
}

TEST(Accuracy, TheChainOfAWreckingBallDoesNotStretchAtAnyPreset) {
  for (const char* links : {"16", "40"}) {
    for (const char* preset : {"draft", "realtime", "accurate", "reference"}) {
      const Scene scene = wrecking_ball(links, preset);
      EXPECT_TRUE(chain_warnings(scene, scenes::kMaxSubsteps).empty());
      const double stretch = stretches(scene);
      std::printf("chain of %s links, %s: stretches by %.1e\n", links, preset, stretch);
      EXPECT_LT(std::abs(stretch), 1e-3);
    }
  }
}

TEST(Accuracy, AChainThatWouldTearIsWarnedOfOnceWithTheSubstepsThatHoldIt) {
  const Scene scene = wrecking_ball("120", "draft", {"accuracy.substeps=4"});
  const std::vector<std::string> warnings = chain_warnings(scene, scenes::kMaxSubsteps);
  ASSERT_EQ(warnings.size(), 1u);
  const int needed = find_chains(scene).front().substeps;
  EXPECT_GT(needed, 4);
  EXPECT_NE(warnings[0].find(std::to_string(needed) + " substeps"), std::string::npos);
  EXPECT_NE(warnings[0].find("'ball.link.0'"), std::string::npos) << warnings[0];
  const auto held = wrecking_ball("120", "draft", {"accuracy.substeps=" + std::to_string(needed)});
  EXPECT_TRUE(chain_warnings(held, scenes::kMaxSubsteps).empty());
  const double before = stretches(scene), then = stretches(held);
  std::printf("chain of 120 links: stretches by %.1e, by %.1e with %d substeps\n", before, then,
              needed);
  EXPECT_GT(before, 0.1);
  EXPECT_LT(std::abs(then), 1e-2);
}

/// Returns the largest displacement, over 10 m, of a thousand tonnes on ropes with a box of 1 kg
/// between the ropes. Stores the settings that the warning names in `named`.
double displacement_on_ropes(std::vector<std::string> set,
                             std::vector<std::string>* named = nullptr) {
  const Scene scene = scenes::parse_scene(R"(
[scene]
description = "x"
duration_s = 2
[accuracy]
[[solid]]
structure = "box"
name = "link"
material = "steel"
size_m = [0.05, 0.05, 0.05]
position = [0, 15, 0]
[[ball]]
name = "ball"
position = [0, 7, 0]
radius_m = 3.1
[[joint]]
kind = "rope"
a = "link"
at = [0, 15.05, 0]
to = [0, 20, 0]
[[joint]]
kind = "rope"
a = "ball"
b = "link"
at = [0, 10.1, 0]
to = [0, 15, 0]
)",
                                          "ropes.toml", {"accurate", std::move(set)});
  if (named) {
    const Accuracy hold =
        divide_step(scene.accuracy, find_chains(scene).front().substeps, scenes::kMaxSubsteps);
    char text[80];
    std::snprintf(text, sizeof text, "accuracy.dt_s=%.17g", hold.dt_s);
    *named = {"accuracy.substeps=" + std::to_string(hold.substeps), text};
  }
  return largest_displacement(scene, 10);
}

TEST(Accuracy, RopesThatTurnALightBoxBetweenThemHoldWithTheSubstepsThatTheWarningNames) {
  std::vector<std::string> named;
  const double before = displacement_on_ropes({}, &named), then = displacement_on_ropes(named);
  std::printf("1e6 kg on ropes with 1 kg between: sinks by %.2g, by %.2g with %s\n", before, then,
              named[0].c_str());
  EXPECT_GT(before, 0.3);
  EXPECT_LT(then, 0.002);
}

}  // namespace
}  // namespace sunder::tests
