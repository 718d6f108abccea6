// Tests of breaks of a solid of several materials.
#include <cmath>

#include <gtest/gtest.h>

#include "fracture/adjacency/compound_builder.h"
#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

constexpr double kToughness = 40;

/// Returns a scene of a brittle cube bonded between two larger cubes of steel, without gravity.
Scene cube_between_steel() {
  Scene scene = bare_scene(1.0 / 120, kToughness, 2000);
  scene.materials[kBrittle.value].smallest_break_m3 = 5;  // it breaks once
  const auto cube = [](double x, double half, MaterialIndex material) {
    return fracture::Part{make_box(Vec3(x - half, -half, -half), Vec3(x + half, half, half)),
                          material};
  };
  scene.solids = {{"cube",
                   fracture::make_compound(
                       {cube(0, 0.5, kBrittle), cube(-1.2, 0.7, kSteel), cube(1.2, 0.7, kSteel)}),
                   {}}};
  return scene;
}

TEST(Materials, ACrackAlongTheBondToSteelTakesTheToughnessOfTheOtherSide) {
  Scene scene = cube_between_steel();
  scene.materials[kSteel.value].toughness_J_m2 = 1e9;
  scene.balls = {steel_ball(0.1, Vec3(0, 0.65, 0), Vec3(0, -40, 0))};
  Trial run(scene);
  while (run.frame->time_s < 0.1) run.step();
  ASSERT_EQ(run.breaks.size(), 1u);
  EXPECT_NEAR(run.breaks[0].energy_J, kToughness * run.breaks[0].new_area_m2,
              1e-9 * run.breaks[0].energy_J);
  EXPECT_GT(run.breaks[0].pieces, 5u);
}

TEST(Materials, ABlastBreaksTheBrittleCubeAlthoughItLoadsTheSteelMore) {
  Scene scene = cube_between_steel();
  scene.blasts = {{0, Vec3(1.2, 1.2, 0), 4, 5000}};
  Trial run(scene);
  while (run.breaks.empty() && run.frame->time_s < 0.1) run.step();
  ASSERT_FALSE(run.breaks.empty());
  EXPECT_LT(std::abs(run.breaks[0].point_W.x()), 0.6) << "on the cube, not on the steel";
}

TEST(Materials, NothingBreaksWhereOnlySteelIsHit) {
  Scene scene = cube_between_steel();
  scene.balls = {steel_ball(0.1, Vec3(1.2, 0.85, 0), Vec3(0, -40, 0))};
  Trial run(scene);
  while (run.frame->time_s < 0.1) run.step();
  EXPECT_TRUE(run.breaks.empty());
}

}  // namespace
}  // namespace sunder::tests
