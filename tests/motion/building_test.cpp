// Tests that a wall hit by many balls keeps its body and loses only the pieces that come off.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/io/statistics.h"
#include "tests/motion/run.h"

namespace sunder::tests {
namespace {

/// Returns a scene of an anchored wall of blocks that `shots` balls hit at once.
Scene wall_under_fire(int shots) {
  Scene scene = bare_scene(1.0 / 120, 600, 2000);
  scene.gravity_W = Vec3(0, -9.81, 0);
  scene.materials[0].youngs_Pa = 1e9;
  scene.materials[0].tensile_Pa = 1e7;
  scene.materials[0].compressive_Pa = 2e7;  // so that pieces do not break by their fall
  scene.solids = {{"wall", fracture::grid_compound(14, 8, 2, Vec3::Constant(0.5), true), {}}};
  for (int i = 0; i < shots; ++i) {
    const Vec3 from(0.75 + 0.8 * (i % 7), 1.2 + 1.6 * (i / 7), 1.4);
    scene.balls.push_back(steel_ball(0.15, from, Vec3(0, 0, -30)));
  }
  return scene;
}

TEST(Building, KeepsItsBodyAndLosesOnlyThePiecesThatComeOff) {
  Scene scene = wall_under_fire(10);
  scene.materials[0].toughness_J_m2 = 3000;
  scene.limits.parts_a_frame = 2000;
  scene.limits.load_work_a_frame = 4000000000;  // only impacts are deferred
  Trial run(scene);
  const double mass = run.frame->report.mass_kg;
  std::uint32_t max_deferred = 0;
  const auto has_deferred = [&] { return run.frame->report.carried_over > 0; };
  // All balls have hit the wall by 0.5 s; falling pieces still cause impacts.
  while (run.frame->time_s < 0.6 || (has_deferred() && run.frame->time_s < 2)) {
    run.step();
    EXPECT_NEAR(run.frame->report.mass_kg, mass, 1e-9 * mass);
    EXPECT_LT(run.frame->report.momentum_residual, 1e-4);
    max_deferred = std::max(max_deferred, run.frame->report.carried_over);
  }
  EXPECT_TRUE(run.body(0).is_static);
  std::size_t of_wall = 0;
  for (const BreakEvent& event : run.breaks) of_wall += event.parent_key == 0 ? 1 : 0;
  EXPECT_GE(of_wall, 13u);
  EXPECT_GT(max_deferred, 4u);
  EXPECT_EQ(run.frame->report.carried_over, 0u);
  EXPECT_GT(run.frame->bodies.size(), 60u);
}

TEST(Building, TheBitsAreEqualForAnyNumberOfThreads) {
  std::vector<std::string> hashes;
  std::vector<std::map<std::string, std::uint64_t>> counts;  // work items, by name
  for (const int count : {1, 2, 4, 7}) {
    set_threads(count);
    Trial run(wall_under_fire(7));
    StateHash hash;
    std::map<std::string, std::uint64_t> counted;
    while (run.frame->time_s < 0.25) {
      run.step();
      hash.take(run.frame);
      for (const WorkItem& item : run.frame->report.work) counted[item.name] += item.count;
    }
    EXPECT_FALSE(run.breaks.empty());
    counts.push_back(counted);
    hashes.push_back(hash.hex());
  }
  set_threads(0);
  for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes[0]);
  for (const auto& counted : counts) EXPECT_EQ(counted, counts[0]);
  for (const char* name : {"boxes that moved", "pairs looked at", "points in substeps",
                           "clusters asked", "breaks planned", "parts cut", "bonds visited"})
    EXPECT_GT(counts[0][name], 0u) << name;
}

}  // namespace
}  // namespace sunder::tests
