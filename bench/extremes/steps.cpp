// Extreme cases with steps far shorter than a preset's, which a scene file may have, and far longer
// ones, which only a scene made in code may have.
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/extremes/extreme.h"

namespace sunder::truths {
// Steps per second.
namespace {

constexpr std::array kHighRates_Hz = {60, 240, 960, 10020};
constexpr std::array kLowRates_Hz = {30, 10};

constexpr const char* kStack = "[[solid]]\nstructure = \"stack\"\nmaterial = \"steel\"\n";
constexpr const char* kBounces = R"(
[[material]]
name = "elastic"
like = "steel"
restitution = 0.8
[[solid]]
structure = "stack"
material = "elastic"
count = 5
size_m = [0.3, 0.3, 0.3]
position = [0, 1, 0]
rotation_deg = [10, 0, 20]
[[ball]]
position = [1, 2, 0]
material = "elastic"
)";
/// Scene text: balls of 25 m/s at an anchored and at a free plate of 50 mm.
constexpr const char* kPlates = R"(
[[solid]]
structure = "box"
name = "held"
material = "steel"
size_m = [2, 2, 0.05]
anchored = "bottom"
[[solid]]
structure = "box"
name = "free"
material = "steel"
size_m = [2, 2, 0.05]
position = [5, 0, 0]
[[ball]]
position = [0, 1, 4]
velocity = [0, 0, -25]
radius_m = 0.1
[[ball]]
position = [5, 1, 4]
velocity = [0, 0, -25]
radius_m = 0.1
)";
constexpr const char* kWall = R"(
[[solid]]
structure = "box"
material = "brick"
size_m = [3, 2, 0.1]
block_m = 0.5
anchored = "bottom"
[[ball]]
position = [0, 1.2, 2]
velocity = [0, 0, -20]
radius_m = 0.3
)";

/// Returns the scene with the longest of the steps, which has the strictest warnings.
template <std::size_t kCount>
SceneAt at_longest_step(const char* text, double duration_s,
                        const std::array<int, kCount>& rates_Hz) {
  return [=](const Preset& preset) {
    Scene scene = scene_at(preset, text, duration_s);
    scene.accuracy.dt_s = 1.0 / *std::min_element(rates_Hz.begin(), rates_Hz.end());
    return scene;
  };
}

/// Measures the worst result over several steps, each the mean over seeds. Scenes made in code may
/// have steps of any length.
template <std::size_t kCount>
Measure worst_of(const char* text, double duration_s, const std::array<int, kCount>& rates_Hz,
                 const std::function<double(const Run&)>& figure,
                 const std::vector<std::string>& set = {}, int seeds = 1) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (const int rate_Hz : rates_Hz) {
      Scene scene = scene_at(preset, text, duration_s, set);
      scene.accuracy.dt_s = 1.0 / rate_Hz;
      const double value = mean_of_seeds(std::move(scene), figure, seeds);
      if (!(value <= worst)) worst = value;
    }
    return worst;
  };
}

double behind_plates(const Run& run) {
  const auto& bodies = run.last->bodies;
  const double free_m = bodies[1].X_WB.position.z();
  return double(bodies[2].X_WB.position.z() < 0) + double(bodies[3].X_WB.position.z() < free_m);
}

/// Relative error of the ball's exit speed with steps of 1/10,020 s, against the preset's step.
double exit_speed_off(const Preset& preset) {
  const auto speed = [&](double dt_s) {
    Scene scene = scene_at(preset, kWall, 0.5);
    scene.accuracy.dt_s = dt_s;
    constexpr int kShots = 80;  // their speeds scatter by a third
    return mean_of_seeds(
        std::move(scene), [](const Run& r) { return r.speed_m_s(1); }, kShots);
  };
  return speed(1.0 / 10020) / speed(preset.dt_s) - 1;
}

}  // namespace

Truths step_extremes() {
  const auto moves = [](const Run& r) { return 1e3 * r.largest_displacement_m(); };
  const auto left_mm = [](const Run& r) { return 1e3 * r.final_penetration_m(); };
  const std::vector<std::string> weightless = {"scene.gravity=[0, 0, 0]"};
  const auto fastest_short = at_longest_step(kWall, 0.5, std::array{10020});
  return {
      extreme(3, "stack of 10, dt 1/60 to 1/10,020, 2 s: moves", "mm", "rest", 2,
              at_longest_step(kStack, 2, kHighRates_Hz), worst_of(kStack, 2, kHighRates_Hz, moves),
              {0.2, 0.2, 0.2, 0.2}),
      extreme(3, "boxes that bounce, dt 1/60 to 1/10,020, 2 s: energy gained", "", "none", 1e-3,
              at_longest_step(kBounces, 2, kHighRates_Hz),
              worst_of(kBounces, 2, kHighRates_Hz, &Run::energy_gained),
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(3, "ball through a wall, dt 1/10,020: exit speed off that of the preset's dt", "",
              "the same", 0.2, fastest_short, Measure(exit_speed_off), {0.05, 0.05, 0.14, 0.061}),
      extreme(4, "stack of 10, dt 1/30 and 1/10, 5 s: moves", "mm", "rest", 2,
              at_longest_step(kStack, 5, kLowRates_Hz), worst_of(kStack, 5, kLowRates_Hz, moves),
              {2, 8800, 0.2, 1500}),
      extreme(4, "boxes that bounce, dt 1/30 and 1/10, 5 s: energy gained", "", "none", 1e-3,
              at_longest_step(kBounces, 5, kLowRates_Hz),
              worst_of(kBounces, 5, kLowRates_Hz, &Run::energy_gained),
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(4, "25 m/s at plates of 50 mm, dt 1/30 and 1/10: pass", "", "none passes", 0,
              at_longest_step(kPlates, 1, kLowRates_Hz),
              worst_of(kPlates, 1, kLowRates_Hz, behind_plates), {0, 0, 0, 0}),
      extreme(4, "ball through a wall, dt 1/30 and 1/10, weightless: energy gained", "", "none",
              1e-3, at_longest_step(kWall, 2, kLowRates_Hz),
              worst_of(kWall, 2, kLowRates_Hz, &Run::energy_gained, weightless),
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(4, "ball through a wall, dt 1/30 and 1/10: overlap left, mean of seeds", "mm",
              "rigid", 10, at_longest_step(kWall, 2, kLowRates_Hz),
              worst_of(kWall, 2, kLowRates_Hz, left_mm, {}, 8), {66, 130, 66, 160}),
  };
}

}  // namespace sunder::truths
