// A check of scenes with one impact against the energy of their break.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/motion/run.h"

namespace sunder::tests {

/// Returns a wall normal to `axis`, anchored at its rim.
inline Solid wall(int axis, const Vec3& center_W, double side_m, double thickness_m) {
  Vec3 size = Vec3::Constant(side_m);
  size[axis] = thickness_m;
  std::uint8_t rim = kAnchoredAllSides;
  for (const bool high : {false, true}) {
    rim = static_cast<std::uint8_t>(rim & ~anchor_side(axis, high));
  }
  return box_solid(center_W, size, rim);
}

inline double ball_kg(const Ball& ball) {
  return 8000 * 4.0 / 3.0 * std::numbers::pi * std::pow(ball.radius_m, 3);
}

inline double kinetic_J(double mass_kg, double speed_m_s) {
  return 0.5 * mass_kg * speed_m_s * speed_m_s;
}

/// Checks a scene `scene_of(speed)` whose impact does the work `work_J(speed)` on the breakable
/// solid. Expects a break if and only if that work exceeds the energy of the break, which must be
/// equal at all speeds, up to the fraction `share` (a body on an arc hits at a slightly different
/// point). If `is_all`, expects that the scene loses exactly the energy of the break.
inline void expect_decided_by_work(const std::function<Scene(double)>& scene_of,
                                   const std::function<double(double)>& work_J, bool is_all = true,
                                   double share = 0) {
  const auto first_break = [&](double speed) {
    Trial run(scene_of(speed));
    while (run.frame->time_s < 0.3 && run.breaks.empty()) run.step();
    return run;
  };
  const Trial strong = first_break(20);
  ASSERT_EQ(strong.breaks.size(), 1u);
  const double enough = 20 * std::sqrt(strong.broken_J / work_J(20));
  EXPECT_TRUE(first_break(0.93 * enough).breaks.empty());
  const Trial barely = first_break(1.07 * enough);
  ASSERT_EQ(barely.breaks.size(), 1u);
  if (share == 0) {
    EXPECT_DOUBLE_EQ(barely.broken_J, strong.broken_J);
  } else {
    EXPECT_NEAR(barely.broken_J, strong.broken_J, share * strong.broken_J);
  }
  if (!is_all) return;
  EXPECT_NEAR(strong.kinetic_J(), work_J(20) - strong.broken_J, 0.03 * work_J(20));
  EXPECT_NEAR(barely.kinetic_J(), work_J(1.07 * enough) - strong.broken_J,
              0.03 * work_J(1.07 * enough));
}

}  // namespace sunder::tests
