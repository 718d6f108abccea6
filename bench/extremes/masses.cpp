// Extreme cases with mass ratios of a million and size ratios of ten thousand.
#include <algorithm>
#include <cmath>

#include "bench/extremes/extreme.h"

namespace sunder::truths {
namespace {

constexpr const char* kMaterials = R"(
[[material]]
name = "light"
like = "steel"
density_kg_m3 = 1
[[material]]
name = "heavy"
like = "steel"
density_kg_m3 = 30000
)";

std::string with_materials(const char* text) { return std::string(kMaterials) + text; }

/// Returns a box of 1 kg with a slab of a million kg at a height of `gap_m` above it.
SceneAt slab_above(double gap_m) {
  return [gap_m](const Preset& preset) {
    const std::string text = with_materials(R"(
[[solid]]
structure = "box"
name = "low"
material = "light"
[[solid]]
structure = "box"
name = "top"
material = "heavy"
size_m = [5, 1.3333, 5]
position = [0, )") + std::to_string(1 + gap_m) +
                             ", 0]\n";
    return scene_at(preset, text, 3);
  };
}

/// Returns a ball of a million kg that hangs by ropes from a box of 1 kg.
Scene ball_on_ropes(const Preset& preset) {
  return scene_at(preset, R"(
[[solid]]
structure = "box"
name = "link"
material = "steel"
size_m = [0.05, 0.05, 0.05]
position = [0, 15, 0]
[[ball]]
name = "ball"
position = [0, 7, 0]
radius_m = 3.1
[[joint]]
kind = "rope"
a = "link"
at = [0, 15.05, 0]
to = [0, 20, 0]
[[joint]]
kind = "rope"
a = "ball"
b = "link"
at = [0, 10.1, 0]
to = [0, 15, 0]
)",
                  3);
}

/// Returns a ball of a million kg that slides through bricks of 1 kg.
Scene through_bricks(const Preset& preset) {
  return scene_at(preset, R"(
[[material]]
name = "light"
like = "steel"
density_kg_m3 = 500
[[solid]]
structure = "brick_wall"
material = "light"
second = "light"
brick_m = [0.2, 0.1, 0.1]
bricks = 10
courses = 10
[[ball]]
position = [0, 3.1, 4]
velocity = [0, 0, -5]
radius_m = 3.1
)",
                  2, {"ground.friction=0"});
}

double speed_lost_to_bricks(const Run& run) {
  return 1 - run.speed_m_s(run.first->bodies.back().key) / 5;
}

Scene small_on_large(const Preset& preset) {
  return scene_at(preset, R"(
[[solid]]
structure = "box"
material = "steel"
size_m = [10, 10, 10]
[[solid]]
structure = "box"
name = "crumb"
material = "steel"
size_m = [0.001, 0.001, 0.001]
position = [1, 10, 2]
)",
                  3);
}

/// Returns a beam of 10 m on two boxes of 1 mm.
Scene beam_on_small_boxes(const Preset& preset) {
  return scene_at(preset, R"(
[[solid]]
structure = "box"
name = "left"
material = "steel"
size_m = [0.001, 0.001, 0.001]
position = [-4, 0, 0]
[[solid]]
structure = "box"
name = "right"
material = "steel"
size_m = [0.001, 0.001, 0.001]
position = [4, 0, 0]
[[solid]]
structure = "box"
name = "beam"
material = "steel"
size_m = [10, 0.1, 0.1]
position = [0, 0.001, 0]
)",
                  3);
}

/// Returns nine balls of 1 mm at 100 m/s in front of a plate of 10 m that is 1 mm thick.
Scene shot_at_plate(const Preset& preset) {
  std::string text = R"(
[[solid]]
structure = "box"
material = "steel"
size_m = [10, 10, 0.001]
anchored = "bottom"
)";
  for (int i = 0; i < 9; ++i)
    text += "[[ball]]\nradius_m = 0.001\nvelocity = [0, 0, -100]\nposition = [" +
            std::to_string(0.4 * (i % 3) - 0.37) + ", " + std::to_string(5 + 0.4 * (i / 3)) +
            ", 2]\n";
  return scene_at(preset, text, 0.2);
}

double behind_plate(const Run& run) {
  return static_cast<double>(std::count_if(
      run.last->bodies.begin(), run.last->bodies.end(),
      [](const FrameBody& body) { return !body.is_static && body.X_WB.position.z() < -0.001; }));
}

/// Returns a wall of 100 m in one piece that a ball of 1 cm breaks.
Scene large_wall(const Preset& preset) {
  return scene_at(preset, R"(
[[material]]
name = "concrete"
toughness_J_m2 = 1
impact_radius_m = 0.05
smallest_piece_m3 = 1e-9
[[solid]]
structure = "box"
size_m = [100, 100, 1]
anchored = "bottom"
[[ball]]
radius_m = 0.01
position = [3, 40, 1]
velocity = [0, 0, -200]
)",
                  0.5);
}

/// Returns a cube of 1 km that falls 1 m.
Scene mountain(const Preset& preset) {
  return scene_at(preset, R"(
[[solid]]
structure = "box"
material = "steel"
size_m = [1000, 1000, 1000]
position = [0, 1, 0]
)",
                  3);
}

}  // namespace

Truths mass_extremes() {
  return {
      extreme(1, "1 kg under a slab of 1e6 kg, 3 s: moves, of its side", "", "rest", 0.02,
              slab_above(0), [](const Run& r) { return r.largest_displacement_m(); },
              {1.2, 1.2, 1.2, 1.2}),
      extreme(1, "slab of 1e6 kg falls 1 m on 1 kg: overlap left, of its side", "", "rigid", 0.02,
              slab_above(1), &Run::final_penetration_m, {0.56, 0.56, 0.56, 0.56}),
      extreme(1, "slab of 1e6 kg falls 1 m on 1 kg: energy gained", "", "none", 1e-3, slab_above(1),
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(1, "1e6 kg on ropes with 1 kg between: sinks, of their length", "", "inextensible",
              0.01, ball_on_ropes, [](const Run& r) { return r.largest_displacement_m() / 10; },
              {0.43, 0.43, 0.43, 0.43}),
      extreme(1, "ball of 1e6 kg through 95 bricks of 1 kg: speed lost", "", "momentum", 0.001,
              through_bricks, speed_lost_to_bricks, {0.0001, 0.00011, 0.00013, 0.00015}),
      extreme(1, "ball of 1e6 kg through 95 bricks of 1 kg: energy gained", "", "none", 1e-3,
              through_bricks, &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
  };
}

Truths size_extremes() {
  return {
      extreme(2, "1 mm on 10 m, 3 s: moves, of its side", "", "rest", 0.02, small_on_large,
              [](const Run& r) { return r.largest_displacement_m() / 0.001; },
              {0.002, 0.002, 0.002, 0.002}),
      extreme(2, "beam of 10 m on 1 mm, 3 s: moves, of its side", "", "rest", 0.02,
              beam_on_small_boxes, [](const Run& r) { return r.largest_displacement_m() / 0.001; },
              {1.2, 1.2, 1.2, 1.2}),
      extreme(2, "9 balls of 1 mm at 100 m/s at a plate of 1 mm: pass", "", "none passes", 0,
              shot_at_plate, behind_plate, {0, 0, 0, 0}),
      extreme(2, "wall of 100 m broken by a ball of 1 cm: mass", "", "constant", 1e-9, large_wall,
              &Run::mass_error, {1e-10, 1e-10, 1e-10, 1e-10}),
      extreme(2, "wall of 100 m broken by a ball of 1 cm: bodies made", "", "some", 1e5, large_wall,
              [](const Run& r) { return double(r.last->bodies.size()) - 2; },
              {1e+04, 1e+04, 1e+04, 1e+04}),
      extreme(2, "cube of 1 km falls 1 m: deepest overlap, of its side", "", "rigid", 0.001,
              mountain, [](const Run& r) { return r.deepest_m / 1000; },
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(2, "cube of 1 km falls 1 m: energy gained", "", "none", 1e-3, mountain,
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
  };
}

}  // namespace sunder::truths
