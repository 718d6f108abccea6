// Extreme cases of gravity (0 to 100 m/s²), friction (0 to 10) and restitution 1.
#include <cmath>

#include "bench/extremes/extreme.h"

namespace sunder::truths {
namespace {

/// Returns a scene text with 27 boxes that fall into a heap; `material` has keys of their material.
std::string heap(const char* material) {
  std::string text = std::string("[[material]]\nname = \"given\"\nlike = \"steel\"\n") + material;
  for (int i = 0; i < 27; ++i)
    text +=
        "[[solid]]\nstructure = \"box\"\nmaterial = \"given\"\nsize_m = [0.5, 0.3, 0.4]\n"
        "rotation_deg = [" +
        std::to_string(7 * i) + ", " + std::to_string(13 * i) + ", 5]\nposition = [" +
        std::to_string(0.9 * (i % 3)) + ", " + std::to_string(1 + 0.9 * (i / 9)) + ", " +
        std::to_string(0.9 * (i / 3 % 3)) + "]\n";
  return text;
}

constexpr const char* kSteelStack = "[[solid]]\nstructure = \"stack\"\nmaterial = \"steel\"\n";
constexpr const char* kFallingWall = R"(
[[solid]]
structure = "box"
material = "brick"
size_m = [3, 2, 0.3]
block_m = 0.5
position = [0, 3, 0]
[[ball]]
position = [0, 4.2, 2]
velocity = [0, 0, -20]
radius_m = 0.3
)";
constexpr const char* kBonded = R"(
[[solid]]
structure = "box"
material = "brick"
size_m = [3, 2, 0.3]
block_m = 0.5
anchored = "bottom"
)";
constexpr const char* kSlider = R"(
[[material]]
name = "given"
like = "steel"
friction = 0
[[solid]]
structure = "box"
material = "given"
velocity = [10, 0, 0]
)";
constexpr const char* kPyramid = R"(
[[material]]
name = "given"
like = "steel"
friction = 0
[[solid]]
structure = "brick_wall"
material = "given"
second = "given"
bricks = 8
courses = 8
[[ball]]
position = [0.1, 0.8, 3]
velocity = [0, 0, -5]
)";
/// Scene text: a flat plate on an anchored slope of 80°.
constexpr const char* kSteep = R"(
[[material]]
name = "rough"
like = "steel"
friction = 10
[[solid]]
structure = "box"
name = "slope"
material = "rough"
size_m = [20, 1, 20]
position = [0, 20, 0]
rotation_deg = [0, 0, 80]
anchored = "bottom"
[[solid]]
structure = "box"
name = "plate"
material = "rough"
size_m = [1, 0.05, 1]
position = [-0.984808, 20.173648, 0]
rotation_deg = [0, 0, 80]
)";

SceneAt with_gravity(double gravity_m_s2, const std::string& text, double duration_s) {
  return [=](const Preset& preset) {
    return scene_at(preset, text, duration_s,
                    {"scene.gravity=[0, " + std::to_string(-gravity_m_s2) + ", 0]"});
  };
}
SceneAt with_ground(const std::string& text, double duration_s, const std::string& ground) {
  return [=](const Preset& preset) { return scene_at(preset, text, duration_s, {ground}); };
}

double moved_mm(const Run& run) { return 1e3 * run.largest_displacement_m(); }

}  // namespace

Truths surface_extremes() {
  const std::string rough = heap("friction = 10\n"), elastic = heap("restitution = 1\n");
  const char* none = "no energy from nowhere";
  const char* smooth_ground = "ground.friction=0";
  const char* rough_ground = "ground.friction=10";
  const char* elastic_ground = "ground.restitution=1";
  return {
      extreme(5, "stack of 10 without gravity, 5 s: moves", "mm", "rest", 2,
              with_gravity(0, kSteelStack, 5), moved_mm, {0.2, 0.2, 0.2, 0.2}),
      extreme(5, "ball at a wall that floats: momentum", "", "constant", 1.3e-5,
              with_gravity(0, kFallingWall, 1), &Run::momentum_error,
              {1.3e-05, 1.3e-06, 3.5e-06, 7e-06}),
      extreme(5, "stack of 10 at 100 m/s², 5 s: moves", "mm", "rest", 2,
              with_gravity(100, kSteelStack, 5), moved_mm, {0.2, 0.2, 0.2, 0.2}),
      extreme(5, "heap of 27 that falls at 100 m/s²: energy gained", "", none, 1e-3,
              with_gravity(100, heap(""), 4), &Run::energy_gained,
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(5, "heap of 27 that falls at 100 m/s²: overlap left", "mm", "rigid", 10,
              with_gravity(100, heap(""), 4),
              [](const Run& r) { return 1e3 * r.final_penetration_m(); }, {1.9, 2.3, 1, 1}),
      extreme(5, "wall of brick at 100 m/s², by statics: moves", "mm", "rest", 2,
              with_gravity(100, kBonded, 2), moved_mm, {0.2, 0.2, 0.2, 0.2}),
      extreme(6, "box at 10 m/s on ground without friction, 5 s: speed lost", "", "none", 1e-3,
              with_ground(kSlider, 5, smooth_ground),
              [](const Run& r) { return 1 - r.speed_m_s(0) / 10; },
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(6, "ball through bricks without friction: energy gained", "", none, 1e-3,
              with_ground(kPyramid, 3, smooth_ground), &Run::energy_gained,
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(6, "plate on a slope of 80°, friction 10, 3 s: slides", "mm", "rest", 1,
              with_ground(kSteep, 3, rough_ground), moved_mm, {0.1, 0.1, 0.1, 0.1}),
      extreme(6, "heap of 27 of friction 10: energy gained", "", none, 1e-3,
              with_ground(rough, 4, rough_ground), &Run::energy_gained,
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(6, "heap of 27 of friction 10: overlap left", "mm", "rigid", 10,
              with_ground(rough, 4, rough_ground),
              [](const Run& r) { return 1e3 * r.final_penetration_m(); }, {1, 1, 1, 1}),
      extreme(7, "heap of 27 of e = 1, 10 s: energy gained", "", none, 1e-3,
              with_ground(elastic, 10, elastic_ground), &Run::energy_gained,
              {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(7, "stack of 10 of e = 1, 5 s: moves", "mm", "rest", 2,
              with_ground(
                  "[[material]]\nname = \"steel\"\nrestitution = 1\n" + std::string(kSteelStack), 5,
                  elastic_ground),
              moved_mm, {0.2, 0.2, 0.2, 0.2}),
      extreme(7, "ball through a wall of e = 1: energy gained", "", none, 1e-3,
              with_ground(
                  "[[material]]\nname = \"brick\"\nrestitution = 1\n" + std::string(kFallingWall),
                  3, elastic_ground),
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
  };
}

}  // namespace sunder::truths
