// Tests that a blast breaks a wall by bending, at the place and impulse of beam theory.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

constexpr double kHeight_m = 4, kThickness_m = 0.4;
constexpr double kDensity = 2000, kYoungs_Pa = 1e10, kTensile_Pa = 1e6;

/// Returns a scene without gravity of a wall, anchored at its foot, and a blast with a plane wave.
Scene blasted_wall(double impulse_Ns_m2) {
  Scene scene = bare_scene(1.0 / 120, 10, kDensity);
  Material& material = scene.materials[0];
  material.pattern.kind = PatternSpec::Kind::kNone;
  material.youngs_Pa = kYoungs_Pa;
  material.tensile_Pa = kTensile_Pa;
  material.shear_Pa = material.compressive_Pa = 100 * kTensile_Pa;
  Compound wall =
      fracture::grid_compound(4, 16, 2, Vec3(kThickness_m / 4, kHeight_m / 16, 0.5), true);
  scene.solids = {{"wall", std::move(wall), {Vec3(0, 0, 0), Quat::Identity()}}};
  Blast blast;
  blast.time_s = 0.02;
  blast.center_W = Vec3(-1000, kHeight_m / 2, 0.5);
  blast.radius_m = 1e6;
  blast.impulse_Ns_m2 = impulse_Ns_m2;
  scene.blasts = {blast};
  return scene;
}

/// Returns the uniform impulse per area, in N s/m², at which the root of a cantilever reaches the
/// strength σ in the shape of its deflection by a uniform load. The deflection u of a load w has
/// ∫u = wL⁵/20EI and ∫u² = 13w²L⁹/3240(EI)²; momentum in that shape deflects the wall by λu,
/// λ² = w∫u / ρA∫u²; the moment at the root is λwL²/2.
double limit_Ns_m2() {
  const double shape = std::sqrt(3240.0 / (20 * 13)) / 2 * 6 / std::sqrt(12.0);
  return kTensile_Pa * kThickness_m / (shape * std::sqrt(kYoungs_Pa / kDensity));
}

TEST(Blast, BreaksAWallAtItsFootAtTheImpulseThatBendsItToItsStrength) {
  const auto breaks = [](double impulse_Ns_m2) {
    Trial run(blasted_wall(impulse_Ns_m2));
    while (run.frame->time_s < 0.2) run.step();
    for (const BreakEvent& event : run.breaks) EXPECT_LT(event.point_W.y(), kHeight_m / 4);
    return !run.breaks.empty();
  };
  EXPECT_FALSE(breaks(0.88 * limit_Ns_m2()));
  EXPECT_TRUE(breaks(1.12 * limit_Ns_m2()));
}

TEST(Blast, AlsoBendsAWallThatAPatternHasBroken) {
  Scene scene = blasted_wall(20 * limit_Ns_m2());
  scene.blasts[0].center_W = Vec3(-1, kHeight_m - 0.5, 0.5);
  scene.blasts[0].radius_m = 20;
  Material& material = scene.materials[0];
  material.pattern.kind = PatternSpec::Kind::kVoronoi;
  material.pattern.cells = 12;
  material.impact_radius_m = 0.4;
  Trial run(scene);
  while (run.frame->time_s < 0.2) run.step();
  double lowest_m = kHeight_m;
  for (const BreakEvent& event : run.breaks) lowest_m = std::min(lowest_m, event.point_W.y());
  EXPECT_GE(run.breaks.size(), 2u);
  EXPECT_LT(lowest_m, kHeight_m / 4);
}

}  // namespace
}  // namespace sunder::tests
