// Symptom: the halves of a dry arch stayed in the air if its keystone was removed just before its
// stones fell asleep. Cause: the time at rest counted from before the removal, so that stones fell
// asleep in the first steps of their fall, and later forces were compared with the forces of those
// steps as those at rest. Fixed in 12ff63c.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

constexpr int kStones = 9, kKeystone = kStones / 2;

/// Returns the largest distance that a stone of [first, last) has fallen from its height `from_m`.
double fall_m(const RigidWorld& world, const std::vector<BodyId>& stones,
              const std::vector<double>& from_m, int first, int last) {
  double most_m = 0;
  for (int i = first; i < last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    most_m = std::max(most_m, from_m[at] - world.state(stones[at]).X_WB.position.y());
  }
  return most_m;
}

TEST(RegressSleep, BothHalvesOfAnArchFallAtWhateverStepItLosesItsKeystone) {
  for (const Preset& preset : kPresets) {
    const bool has_short_steps = preset.dt_s < 1.0 / 400;
    const int first = static_cast<int>(std::lround(0.4 / preset.dt_s));
    const int last = static_cast<int>(std::lround(0.6 / preset.dt_s));
    for (int steps = first; steps <= last; steps += has_short_steps ? 4 : 1) {
      RigidWorld world(options_of(preset));
      world.add(RigidWorld::ground());
      std::vector<BodyId> stones;
      for (int i = 0; i < kStones; ++i)
        stones.push_back(world.add(RigidWorld::voussoir(i, kStones, 0.25)));
      world.run(steps * preset.dt_s, preset.dt_s, preset.substeps);
      std::vector<double> from_m;
      for (const BodyId stone : stones) from_m.push_back(world.state(stone).X_WB.position.y());
      world.remove(stones[kKeystone]);
      world.run(1.5, preset.dt_s, preset.substeps);
      EXPECT_GT(fall_m(world, stones, from_m, 0, kKeystone), 0.1) << preset.name << ' ' << steps;
      EXPECT_GT(fall_m(world, stones, from_m, kKeystone + 1, kStones), 0.1)
          << preset.name << ' ' << steps;
    }
  }
}

}  // namespace
}  // namespace sunder::solver
