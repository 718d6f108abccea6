// Accuracy asked for in metres, and warnings where a preset is not enough.
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/world/load_path.h"
#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/load.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::tests {
namespace {

constexpr double kG = 9.81;

/// A stack of unit boxes of steel; with a heavier top, if there is one, of so many times the
/// weight.
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

TEST(Accuracy, AStackCountsByItsHeightAndAHeavyTopByItsWeight) {
  const LoadPath even = load_paths(stack(10, 1, "accurate")).deepest;
  EXPECT_EQ(even.bodies, 10u);
  EXPECT_NEAR(even.load, 10, 1e-9);
  EXPECT_NEAR(even.size_m, 1, 1e-9);
  const LoadPath heavy = load_paths(stack(10, 100, "accurate")).deepest;
  EXPECT_NEAR(heavy.load, 109, 1e-9);
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
      EXPECT_EQ(substeps, substeps_for_sink(load_paths(scene).deepest, kG, 1.0 / 120, target));
      EXPECT_LT(reached, 1.2 * target);
    }
  }
}

TEST(Accuracy, AWarningNamesTheSubstepsThatWouldDo) {
  EXPECT_EQ(accuracy_warning(stack(10, 1, "draft")), "");
  EXPECT_EQ(accuracy_warning(stack(10, 1, "accurate")), "");
  const Scene heavy = stack(10, 10000, "accurate");
  const int needed = substeps_to_stand(load_paths(heavy).weakest, kG, heavy.accuracy.dt_s);
  EXPECT_GT(needed, heavy.accuracy.substeps);
  const std::string warning = accuracy_warning(heavy);
  EXPECT_NE(warning.find(std::to_string(needed) + " substeps"), std::string::npos) << warning;
  EXPECT_NE(warning.find("10 bodies"), std::string::npos) << warning;
  const Scene held = stack(10, 10000, "accurate", {"accuracy.substeps=" + std::to_string(needed)});
  EXPECT_EQ(accuracy_warning(held), "");
}

}  // namespace
}  // namespace sunder::tests
