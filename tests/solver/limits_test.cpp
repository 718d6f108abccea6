// Tests that the limits of the solvers are counted by name in the report of the solve that reaches
// them.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "solver/planar/planar_physics.h"
#include "tests/fixtures/presets.h"
#include "tests/solver/chains.h"

namespace sunder::solver::limits_test {
namespace {

using W = RigidWorld;
using Names = std::map<std::string, std::uint32_t>;
constexpr double kDt_s = 1.0 / 60;

Names names(const SolveReport& report) {
  Names all;
  report.limits.for_each(
      [&](const LimitText& text, std::uint32_t count) { all[text.name] = count; });
  return all;
}

TEST(SolverLimits, StepsWithSkippedContactsOfDenseClustersAreCounted) {
  for (const int count : {8, 100}) {
    RigidWorld world(awake(Vec3::Zero()));
    for (int i = 0; i < count; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(0.001 * i, 0, 0)));
    EXPECT_EQ(names(world.step(kDt_s, 4)), count == 8 ? Names() : (Names{{"dense_clusters", 1}}));
  }
}

TEST(SolverLimits, StepsInWhichAnImpactDoesNotReachAllBodiesAreCounted) {
  for (const double ratio : {1.0, 1000.0}) {  // a light box between two that may be heavier
    RigidWorld world(awake(Vec3::Zero()));
    for (int i = 0; i < 3; ++i) {
      const BodyDesc box = W::box(Vec3(1, 1, 1), Vec3(i, 0, 0), i == 1 ? 1000 : 1000 * ratio);
      world.add(i == 0 ? W::moving(box, Vec3(100, 0, 0)) : box);
    }
    EXPECT_EQ(names(world.step(0.5 * kDt_s, 4)),
              ratio == 1 ? Names() : (Names{{"impact_sweeps", 1}}));
  }
}

TEST(SolverLimits, StepsWithChainsThatAreSolvedInPartsAreCounted) {
  for (const int links : {20, 600}) {
    RigidWorld world(awake());
    add_chain(world, {.links = links});
    EXPECT_EQ(names(world.step(kDt_s, 4)), links == 20 ? Names() : (Names{{"joint_band", 1}}));
  }
}

TEST(SolverLimits, StepsInWhichBodiesAreSlowedDownAreCounted) {
  for (const bool fast : {false, true}) {
    for (const bool spins : {false, true}) {
      RigidWorld world(awake(Vec3::Zero()));
      BodyDesc box = W::box(Vec3(0.1, 0.1, 0.1), Vec3::Zero());
      (spins ? box.angular_velocity_W : box.velocity_W) =
          (spins ? 1e6 : 1e5) * (fast ? 3 : 0.9) * Vec3(1, 0, -0.5);
      const BodyId id = world.add(box);
      EXPECT_EQ(names(world.step(kDt_s, 4)), fast ? (Names{{"speeds", 1}}) : Names());
      const BodyState state = world.state(id);
      const Vec3 kept = spins ? state.angular_velocity_W / 1e6 : state.velocity_W / 1e5;
      EXPECT_NEAR((kept - (fast ? 1 : 0.9) * Vec3(1, 0, -0.5)).norm(), 0, 1e-6)
          << "in its direction";
      EXPECT_EQ(names(world.step(kDt_s, 4)), Names()) << "once";
    }
  }
}

// Pushed by huge impulses between steps, and thrown at others.
TEST(SolverLimits, BodiesThatAreTooFastAreSlowedDownWithAllMomentumAndEnergyAccountedFor) {
  for (const double speed_m_s : {1.1e5, 1e7, 1e10, 1e20, 1e100}) {
    RigidWorld world(awake(Vec3::Zero()));
    const BodyDesc box = W::box(Vec3::Ones(), Vec3::Zero());
    const BodyId id = world.add(box);
    for (int i = 0; i < 5; ++i) world.add(W::box(Vec3::Ones(), Vec3(900 + 1.0 * i, 0.3 * i, 0)));
    const double before_J = world.kinetic_energy();
    world.physics().apply_impulse(id, box.mass_kg * speed_m_s * Vec3::UnitX(), Vec3::Zero());
    const double pushed_J = world.kinetic_energy() - before_J;
    EnergyFlows flows;
    for (int i = 0; i < 4; ++i) {
      const SolveReport report = world.step(kDt_s, 4);
      EXPECT_EQ(report.frozen, 0u);
      const Vec3 error_Ns =
          report.momentum_after_Ns - report.momentum_before_Ns - report.external_impulse_Ns;
      EXPECT_LT(error_Ns.norm(), 1e-6 * box.mass_kg * 1e5) << speed_m_s;
      EXPECT_EQ(report.limits[Limit::kSpeeds], i == 0 ? 1u : 0u) << speed_m_s;
      flows += report.energy;
    }
    const double change_J = world.kinetic_energy() - before_J;
    EXPECT_NEAR(change_J, pushed_J + flows.sum(), 1e-9 * pushed_J) << speed_m_s;
    for (std::size_t i = 0; i < world.size(); ++i) {
      const BodyState state = world.state(world.id(i));
      EXPECT_LE(state.velocity_W.cwiseAbs().maxCoeff(), 1e5);
      EXPECT_TRUE(state.X_WB.position.allFinite());
    }
    EXPECT_GT(world.state(id).X_WB.position.x(), 800) << "it moves on";
  }
}

TEST(SolverLimits, PlanarStepsWithABodyThatMayPassThroughOthersAreCounted) {
  for (const double speed_m_s : {100.0, 1e6}) {
    RigidWorld world(make_planar_physics({}));
    BodyDesc ball = W::sphere(0.05, Vec3::Zero());
    ball.velocity_W = Vec3(speed_m_s, 0, 0);
    world.add(ball);
    EXPECT_EQ(names(world.step(kDt_s, 4)),
              speed_m_s == 100 ? Names() : (Names{{"planar_steps", 1}}));
  }
}

}  // namespace
}  // namespace sunder::solver::limits_test
