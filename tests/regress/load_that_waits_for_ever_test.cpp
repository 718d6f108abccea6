// Symptom: reports continued to count a load as carried over after its solid had been removed.
// Cause: the load stage returned before it set its count if no solid was left that a load could
// break. Fixed in 648d814.
#include <gtest/gtest.h>

#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedBreaker;
using testing::ScriptedPhysics;

/// Returns two boxes on top of each other, the lower one anchored.
Solid tower() {
  Solid solid;
  for (int i = 0; i < 2; ++i) {
    const Vec3 min(0, i, 0);
    solid.compound.convexes.push_back(
        make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    solid.compound.anchored.push_back(i == 0 ? kAnchoredAllSides : 0);
  }
  solid.compound.bonds = {{0, 1, 3, 2, 1}};
  return solid;
}

TEST(RegressLoad, NoneIsCarriedOverOnceNoSolidIsLeftThatALoadCouldBreak) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].tensile_Pa = 1e6;
  scene.accuracy = {1.0 / 60, 1};
  scene.solids = {tower(), tower()};
  scene.removals = {{1.5 / 60, {0, 1}, {}}};
  scene.limits.load_work_a_frame = 1;  // enough for one of the two
  auto breaker = std::make_unique<ScriptedBreaker>(1.0);
  breaker->stressed = [](const Structure&, const LoadCase& load) {
    StressResult answer;
    answer.work = load.most_work;
    return answer;
  };
  Simulation simulation(std::move(scene),
                        std::make_unique<ScriptedPhysics>([](const ScriptedPhysics&, int) {
                          return std::vector<SpeculativeContact>{};
                        }),
                        std::move(breaker));
  EXPECT_EQ(simulation.next()->report.carried_over, 0u) << "before the first step";
  EXPECT_EQ(simulation.next()->report.carried_over, 1u);
  EXPECT_EQ(simulation.next()->report.carried_over, 0u);
}

}  // namespace
}  // namespace sunder
