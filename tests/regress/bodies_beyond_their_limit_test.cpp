// Symptom: two boxes hit at once both broke, and their pieces exceeded limits.bodies. Cause: each
// break alone was compared with the limit. The pieces of all breaks of an impact are now added up.
#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder {
namespace {

constexpr const char* kScene = R"(
[scene]
description = "A plate flies at two boxes side by side."
duration_s = 0.2
[limits]
bodies = 30
[[material]]
name = "soft"
like = "brick"
strength_Ns = 0
toughness_J_m2 = 1
impact_radius_m = inf
smallest_piece_m3 = 0
crumbling = { particles_per_m2 = 0 }
pattern = { kind = "grid", cells = 3 }
[[solid]]
structure = "box"
name = "left"
material = "soft"
size_m = [0.5, 0.5, 0.5]
position = [-0.25, 0, 0]
[[solid]]
structure = "box"
name = "right"
material = "soft"
size_m = [0.5, 0.5, 0.5]
position = [0.25, 0, 0]
[[solid]]
structure = "box"
name = "plate"
material = "steel"
size_m = [2, 0.4, 0.2]
position = [0, 0.05, 0.5]
velocity = [0, 0, -20]
)";

TEST(BodiesBeyondTheirLimit, SimultaneousBreaksStayBelowTheLimitTogether) {
  const auto simulation = scenes::make_simulation(scenes::parse_scene(kScene, "two.toml"));
  std::uint32_t most = 0, limits_hit = 0;
  while (const FramePtr frame = simulation->next()) {
    most = std::max(most, frame->report.counts.bodies);
    limits_hit += frame->report.limits_hit;
  }
  EXPECT_GT(most, 3u);
  EXPECT_LE(most, 30u);
  EXPECT_GT(limits_hit, 0u);
}

}  // namespace
}  // namespace sunder
