// Tests of terrain from heights: its volume, its anchors, and its smoothness for a rolling ball.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes::terrain_test {
namespace {

constexpr const char* kHead = "[scene]\ndescription = \"x\"\n";

std::string refusal(const std::string& heights) {
  try {
    parse_scene(kHead + ("[[solid]]\nstructure = \"terrain\"\nheights_m = " + heights), "x.toml",
                {});
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Terrain, IsOneSolidOfPrismsUnderItsTriangles) {
  const Scene scene = parse_scene(
      std::string(kHead) +
          "[[solid]]\nstructure = \"terrain\"\nspacing_m = 2\nfloor_m = 0.5\nanchored = \"all\"\n"
          "heights_m = [[1, 4, 2], [3, 2, 5]]",
      "x.toml", {});
  ASSERT_EQ(scene.solids.size(), 1u);
  const Compound& ground = scene.solids[0].compound;
  EXPECT_EQ(ground.convexes.size(), 4u);
  // Heights over the foot: the lowest is 0.5 m above it. Triangles meet along rows' diagonals.
  const double sums = (1 + 2 + 4) + (1 + 2 + 3) + (4 + 5 + 2) + (4 + 5 + 2) - 12 * 0.5;
  EXPECT_NEAR(volume(ground), 2 * sums / 3, 1e-9);
  EXPECT_EQ(bounds(ground).min, Vec3(-2, 0, -1));
  EXPECT_EQ(bounds(ground).max, Vec3(2, 4.5, 1));
  for (const std::uint8_t anchored : ground.anchored) EXPECT_EQ(anchored, kAnchoredAllSides);
}

TEST(Terrain, RefusesHeightsThatAreNoGrid) {
  for (const char* heights : {"[[1, 2]]", "[[1], [2]]", "[[1, 2], [3]]", "[1, 2]", "[]", "7",
                              "[[1, 2], [3, \"x\"]]", "[[1, 2], [3, 4000]]"}) {
    const std::string said = refusal(heights);
    EXPECT_TRUE(said.starts_with("x.toml:5: heights_m in [[solid]] terrain is ") &&
                said.ends_with("; allowed: [[h, h, ...], ...], two rows or more of equal length, "
                               "two or more, each a number from -1000 to 1000, in m"))
        << said;
  }
}

/// Returns the distance that a ball has rolled down a slope of 3 in 10 after two seconds, in m.
double rolled_m(const std::string& ground) {
  Scene scene = parse_scene(
      kHead + ground + "anchored = \"all\"\n[[ball]]\nradius_m = 0.4\nposition = [-8, 6.82, 0.2]",
      "x.toml", {});
  const auto simulation = make_simulation(std::move(scene));
  FramePtr frame;
  for (int i = 0; i <= 120; ++i) frame = simulation->next();
  for (const FrameBody& body : frame->bodies)
    if (body.com_R.isZero()) return (body.X_WB.position - Vec3(-8, 6.82, 0.2)).norm();
  return 0;
}

TEST(Terrain, IsRolledOverAlmostAsOneFace) {
  std::string heights = "heights_m = [";
  for (int row = 0; row < 7; ++row) {
    heights += "[";
    for (int x = 0; x <= 20; ++x) heights += std::to_string(0.3 * (20 - x)) + ", ";
    heights += "], ";
  }
  const double on_terrain = rolled_m("[[solid]]\nstructure = \"terrain\"\n" + heights + "]\n");
  const double on_ramp = rolled_m(
      "[[solid]]\nstructure = \"prism\"\nmaterial = \"foundation\"\ndepth_m = 6\n"
      "outline_m = [[-10, 0], [10, 0], [10, 1], [-10, 7]]\n");
  // Distance of a ball that does not slip: 5/7 g sin a t²/2.
  const double slope = std::atan(0.3), rolls_m = 5.0 / 7 * 9.81 * std::sin(slope) * 2;
  EXPECT_NEAR(on_ramp, rolls_m, 0.1 * rolls_m);
  EXPECT_NEAR(on_terrain, on_ramp, 0.05 * on_ramp) << "the ball passes some thirty edges";
}

}  // namespace
}  // namespace sunder::scenes::terrain_test
