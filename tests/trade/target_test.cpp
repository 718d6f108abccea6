// Tests of the error target in metres: runs reach it, and stay within a factor of two of it.
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kGap_m = 1e-3;  // initial gap below each body

/// Returns a stack of wooden boxes with gaps of a millimetre: a stack that starts in balance would
/// not penetrate at all. Wood has no fracture pattern and does not break.
std::string stack(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += "[[solid]]\nstructure = \"box\"\nname = \"box " + std::to_string(i) +
            "\"\nmaterial = \"wood\"\nposition = [0, " + std::to_string(i + (i + 1) * kGap_m) +
            ", 0]\n";
  return text;
}

/// Returns a pyramid of wooden boxes, each on two of the row below.
std::string pyramid(int rows) {
  std::string text;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      text += "[[solid]]\nstructure = \"box\"\nname = \"box " + std::to_string(row * rows + i) +
              "\"\nmaterial = \"wood\"\nsize_m = [1, 0.5, 1]\nposition = [" +
              std::to_string((i + 0.5 * row) * 1.1) + ", " +
              std::to_string(0.5 * row + (row + 1) * kGap_m) + ", 0]\n";
  return text;
}

/// Returns the deepest penetration after all bodies are at rest, over the target.
double reached(const std::string& solids, double target_m, const std::string& dt_s) {
  char target[40];
  std::snprintf(target, sizeof target, "accuracy.error_target_m=%g", target_m);
  const std::string text = "[scene]\ndescription = \"x\"\nduration_s = 3\n[accuracy]\n" + solids;
  const auto simulation = make_simulation(
      parse_scene(text, "stack.toml", {"realtime", {target, "accuracy.dt_s=" + dt_s}}));
  FramePtr last;
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  EXPECT_EQ(last->report.counts.awake, 0u);
  double deepest_m = 0;
  for (const float depth_m : last->report.penetrations_m)
    deepest_m = std::max(deepest_m, double{depth_m});
  std::printf("target %.0e m, dt %s s: reached %.2f of it\n", target_m, dt_s.c_str(),
              deepest_m / target_m);
  return deepest_m / target_m;
}

TEST(Target, BodiesSetDownPenetrateByTheTargetWithinAFactorOfTwo) {
  for (const std::string& solids : {stack(5), stack(20), pyramid(8)}) {
    for (const double target_m : {2e-3, 5e-4, 1e-4, 2e-5}) {
      const double over = reached(solids, target_m, "0.00833333333333");
      EXPECT_GT(over, 0.5);
      EXPECT_LT(over, 2);
    }
  }
}

TEST(Target, IsKeptAtAnyStep) {
  for (const char* dt_s : {"0.0166666666667", "0.00416666666667"}) {
    const double over = reached(stack(10), 1e-4, dt_s);
    EXPECT_GT(over, 0.5);
    EXPECT_LT(over, 2);
  }
}

}  // namespace
}  // namespace sunder::scenes
