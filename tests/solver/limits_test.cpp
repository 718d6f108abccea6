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
