// Tests of breaks by impacts: the speed that breaks a solid against closed forms, and the number of
// pieces against common experience.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder {
namespace {

/// Returns the largest number of bodies and debris in a frame of a scene, without its static body.
std::size_t pieces(const std::string& text) {
  const auto simulation = scenes::make_simulation(scenes::parse_scene(text, "x.toml", {}));
  std::size_t most = 0;
  while (const FramePtr frame = simulation->next())
    most = std::max(most, frame->bodies.size() + frame->debris.size());
  return most - 1;
}

/// Returns a scene in which a box strikes an anchored box with a flat side, without gravity.
std::string head_on(const std::string& size, const std::string& material, const std::string& other,
                    double speed_m_s) {
  return R"(
[scene]
description = "x"
duration_s = 0.2
gravity = [0, 0, 0]
[[solid]]
structure = "box"
size_m = [2, 1, 2]
anchored = "all"
material = ")" +
         other + R"("
[[solid]]
structure = "box"
name = "thing"
size_m = )" +
         size + "\nmaterial = \"" + material + "\"\nposition = [0, 1.01, 0]\nvelocity = [0, " +
         std::to_string(-speed_m_s) + ", 0]\n";
}

double impedance(double youngs_Pa, double density_kg_m3) {
  return std::sqrt(youngs_Pa * density_kg_m3);
}

/// Returns the speed at which a quarter of the energy of a body pays for a crack across it.
double crack_m_s(double toughness_J_m2, double density_kg_m3, double volume_m3) {
  return std::sqrt(2 * toughness_J_m2 / (0.24 * density_kg_m3 * std::cbrt(volume_m3)));
}

TEST(Strength, of_compact_bodies_is_that_of_the_stress_wave_in_both_and_of_a_crack_across) {
  const double clay = impedance(1e10, 1900), concrete = impedance(3e10, 2400);
  const double brick_m_s = std::hypot(2e7 * (1 / clay + 1 / concrete),
                                      crack_m_s(60, 1900, 0.24 * 0.08 * 0.12)),
               cube_m_s = std::hypot(3e7 * (2 / concrete), crack_m_s(100, 2400, 0.027));
  EXPECT_EQ(pieces(head_on("[0.24, 0.08, 0.12]", "clay", "concrete", 0.98 * brick_m_s)), 1u);
  EXPECT_GT(pieces(head_on("[0.24, 0.08, 0.12]", "clay", "concrete", 1.02 * brick_m_s)), 3u);
  EXPECT_EQ(pieces(head_on("[0.3, 0.3, 0.3]", "concrete", "concrete", 0.98 * cube_m_s)), 1u);
  EXPECT_GT(pieces(head_on("[0.3, 0.3, 0.3]", "concrete", "concrete", 1.02 * cube_m_s)), 3u);
}

TEST(Strength, of_plates_that_land_flat_is_that_in_bending_and_of_a_crack_across) {
  const double glass_m_s =
      std::hypot(0.78 * 4e7 / impedance(7e10, 2500), crack_m_s(8, 2500, 0.1 * 0.004 * 0.1));
  EXPECT_EQ(pieces(head_on("[0.1, 0.004, 0.1]", "glass", "concrete", 0.98 * glass_m_s)), 1u);
  EXPECT_GT(pieces(head_on("[0.1, 0.004, 0.1]", "glass", "concrete", 1.02 * glass_m_s)), 3u);
}

/// Returns a scene in which a steel ball strikes the middle of a pane of 1 m², 6 mm thick.
std::string shot_at_pane(double mass_kg, double speed_m_s) {
  const double radius_m = std::cbrt(3 * mass_kg / (4 * std::numbers::pi * 7800));
  return R"(
[scene]
description = "x"
duration_s = 0.3
[[solid]]
structure = "box"
size_m = [1, 1, 0.006]
anchored = "bottom"
material = "glass"
[[script.shot]]
time_s = 0.02
from = [0, 0.5, 0.2]
velocity = [0, 0, )" +
         std::to_string(-speed_m_s) + "]\nradius_m = " + std::to_string(radius_m) + "\n";
}

TEST(Strength, gives_a_pane_more_pieces_the_harder_it_is_struck) {
  EXPECT_EQ(pieces(shot_at_pane(0.5, 2)), 1u);
  const std::size_t few = pieces(shot_at_pane(0.5, 5)), many = pieces(shot_at_pane(0.5, 20));
  EXPECT_GT(few, 5u);
  EXPECT_GT(many, 3 * few / 2);
}

TEST(Strength, of_a_pane_needs_three_metres_a_second_of_a_small_ball) {
  EXPECT_EQ(pieces(shot_at_pane(0.1, 2.8)), 1u);
  const std::size_t broken = pieces(shot_at_pane(0.1, 3.1));
  EXPECT_GT(broken, 3u);
  EXPECT_LT(broken, 15u);
}

std::vector<std::string> warnings(const std::string& key) {
  std::vector<std::string> told;
  scenes::SimulationOptions options;
  options.warn = [&](const std::string& text) { told.push_back(text); };
  const std::string text =
      "[[material]]\nname = \"clay\"\n" + key + head_on("[1, 1, 1]", "clay", "concrete", 1);
  scenes::make_simulation(scenes::parse_scene(text, "x.toml", {}), options);
  return told;
}

TEST(Strength, as_an_impulse_gives_a_warning) {
  EXPECT_TRUE(warnings("").empty());
  for (const char* key : {"strength_Ns = 5\n", "smallest_break_m3 = 0.01\n"}) {
    const std::vector<std::string> told = warnings(key);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("'clay' are obsolete"), std::string::npos) << told[0];
  }
}

}  // namespace
}  // namespace sunder
