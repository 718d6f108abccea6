// Symptom: of two blasts due in one step on one solid, only one broke it in that step; if the other
// had been tried in the meantime, it never broke the solid. Cause: only one impact of a blast was
// kept per solid, and the impacts dropped had been marked as tried.
#include <algorithm>

#include <gtest/gtest.h>

#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

/// Returns the x of each break of a wall in its first frame under these blasts, ascending.
std::vector<double> broken_at_x(bool anchored, std::initializer_list<double> blasts_at_x) {
  std::string text =
      "[scene]\ndescription = \"x\"\ngravity = [0, 0, 0]\n[accuracy]\ndt_s = 0.01666666667\n"
      "[limits]\nparts_a_frame = 100000\n"
      "[[solid]]\nstructure = \"box\"\nsize_m = [12, 3, 0.4]\nblock_m = 1\nposition = [0, 1, 0]\n";
  if (anchored) text += "anchored = \"all\"\n";
  for (const double x : blasts_at_x) {
    text += "[[script.blast]]\ntime_s = 0\nradius_m = 3\nimpulse_Ns_m2 = 20000\nat = [" +
            std::to_string(x) + ", 2.5, 1]\n";
  }
  const auto simulation = make_simulation(parse_scene(text, "x.toml", {}));
  simulation->next();
  std::vector<double> at;
  const FramePtr frame = simulation->next();
  for (const BreakEvent& event : frame->breaks) at.push_back(event.point_W.x());
  std::ranges::sort(at);
  return at;
}

TEST(RegressBlasts, TwoInOneStepBothBreakOneSolid) {
  for (const bool anchored : {true, false}) {
    const std::vector<double> left = broken_at_x(anchored, {-4}),
                              right = broken_at_x(anchored, {4});
    ASSERT_EQ(left.size(), 1u);
    ASSERT_EQ(right.size(), 1u);
    const std::vector<double> both = broken_at_x(anchored, {-4, 4});
    ASSERT_EQ(both.size(), 2u) << "anchored: " << anchored;
    EXPECT_NEAR(both[0], left[0], 1e-9);
    EXPECT_NEAR(both[1], right[0], 1e-9);
  }
}

TEST(RegressBlasts, TwoAtOnePlaceBreakOneSolidTwice) {
  EXPECT_EQ(broken_at_x(false, {0, 0}).size(), 2u);
  EXPECT_EQ(broken_at_x(true, {0, 0}).size(), 2u);
}

}  // namespace
}  // namespace sunder::scenes
