// Tests of glass hit by many balls, with pieces of any size as bodies: thin pieces (slivers) stay
// finite and bounded in speed, and mass, momentum and energy are accounted for.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

constexpr double kBall_m_s = 40;

/// Returns a scene of a pane 2 cm thick, anchored at its foot, that twelve balls hit. Pieces of any
/// size are bodies and nearly all can break again.
Scene pane_under_fire(std::uint64_t seed, PatternSpec::Kind pattern) {
  Scene scene = bare_scene(1.0 / 60, 8, 2500);
  Material& glass = scene.materials[0];
  glass.pattern.kind = pattern;
  glass.pattern.cells = 40;
  glass.friction = 0.4;
  glass.smallest_piece_m3 = 0;
  glass.smallest_break_m3 = 1e-7;
  glass.impact_radius_m = 0.4;
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.ground.height_m = -0.01;
  scene.solids = {{"pane", fracture::grid_compound(2, 2, 1, Vec3(0.8, 0.6, 0.02), true), {}}};
  Random random(seed, 1);
  for (int i = 0; i < 12; ++i) {
    const Vec3 from(random.uniform(0.1, 1.5), random.uniform(0.2, 1.1), 0.3 + 0.4 * i);
    scene.balls.push_back(steel_ball(0.04, from, Vec3(0, 0, -kBall_m_s)));
  }
  return scene;
}

void expect_bounded(const Trial& run, double input_J) {
  for (const FrameBody& body : run.frame->bodies) {
    ASSERT_TRUE(body.X_WB.position.allFinite() && body.velocity_W.allFinite() &&
                body.angular_velocity_W.allFinite() && body.X_WB.rotation.coeffs().allFinite())
        << body.key;
    // A light body hit by a heavy one leaves at twice its speed, and may be hit again. A body
    // pinched between two others without friction is ejected faster than these close.
    ASSERT_LT(body.velocity_W.norm(), 7 * kBall_m_s) << body.key << " at " << run.frame->time_s;
  }
  EXPECT_EQ(run.frame->report.frozen, 0u);
  EXPECT_LT(run.frame->report.momentum_residual, 1e-3);
  EXPECT_LE(run.kinetic_J() + run.broken_J, 1.001 * input_J) << run.frame->time_s;
}

TEST(Slivers, OfAPaneUnderFireStayFiniteAndGainNoEnergy) {
  for (const auto pattern : {PatternSpec::Kind::kVoronoi, PatternSpec::Kind::kWeb}) {
    Trial run(pane_under_fire(5, pattern));
    const double mass_kg = run.frame->report.mass_kg;
    // Pieces that come off the pane add their potential energy.
    const double input_J = run.kinetic_J() + run.frame->report.potential_J + mass_kg * 9.81;
    std::size_t most = 0;
    while (run.frame->time_s < 0.8) {
      run.step();
      ASSERT_NO_FATAL_FAILURE(expect_bounded(run, input_J));
      EXPECT_NEAR(run.frame->report.mass_kg, mass_kg, 1e-6 * mass_kg);
      most = std::max(most, run.frame->bodies.size());
    }
    EXPECT_GT(run.breaks.size(), 12u);
    EXPECT_GT(most, 200u);
    std::printf("slivers: %zu bodies, %zu breaks\n", most, run.breaks.size());
  }
}

}  // namespace
}  // namespace sunder::tests
