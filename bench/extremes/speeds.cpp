// Extreme cases with a ball of 1,000 m/s.
#include <cmath>

#include "bench/extremes/extreme.h"

namespace sunder::truths {
namespace {

constexpr const char* kPlate = R"(
[[material]]
name = "hard"
like = "steel"
yield_Pa = 0
tensile_Pa = 0
shear_Pa = 0
compressive_Pa = 0
[[solid]]
structure = "box"
material = "hard"
size_m = [3, 3, 0.01]
anchored = "bottom"
)";
constexpr const char* kPane = R"(
[[solid]]
structure = "pane"
width_m = 3
height_m = 2.6
)";
constexpr const char* kBrickWall = R"(
[[solid]]
structure = "box"
material = "brick"
size_m = [3, 3, 0.3]
block_m = 0.5
anchored = "bottom"
)";
constexpr const char* kBricks = R"(
[[solid]]
structure = "brick_wall"
brick_m = [0.4, 0.2, 0.3]
bricks = 8
courses = 12
)";

/// Returns a target that a steel ball hits 1.45 m above the ground at 1,000 m/s.
SceneAt shot_at(const char* target) {
  return [target](const Preset& preset) {
    return scene_at(preset,
                    target + std::string("[[ball]]\nposition = [0.05, 1.45, 5]\nvelocity = [0, 0, "
                                         "-1000]\nradius_m = 0.1\n"),
                    1);
  };
}

double depth_left_mm(const Run& run) { return 1e3 * run.final_penetration_m(); }

/// Returns 1 if the ball has passed through a plate that it cannot break.
double passes(const Run& run) { return double(run.last->bodies[1].X_WB.position.z() < 0); }

/// Fraction of its speed that the ball, body 1 of the scene, has lost.
double speed_lost(const Run& run) { return 1 - run.speed_m_s(1) / 1000; }

}  // namespace

Truths speed_extremes() {
  const char* none = "no energy from nowhere";
  return {
      extreme(8, "1,000 m/s at a plate of 10 mm that holds: passes", "", "no", 0, shot_at(kPlate),
              passes, {0, 0, 0, 0}),
      extreme(8, "1,000 m/s at a pane: energy gained", "", none, 1e-3, shot_at(kPane),
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(8, "1,000 m/s at a pane: speed lost, of 1,000 m/s", "", "a pane is thin", 0.2,
              shot_at(kPane), speed_lost, {0.16, 0.11, 0.13, 0.17}),
      extreme(8, "1,000 m/s at a wall of brick: energy gained", "", none, 1e-3, shot_at(kBrickWall),
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(8, "1,000 m/s at a wall of brick: mass", "", "constant", 1e-9, shot_at(kBrickWall),
              &Run::mass_error, {1e-10, 1e-10, 1e-10, 1e-10}),
      extreme(8, "1,000 m/s at a wall of brick: overlap left", "mm", "rigid", 50,
              shot_at(kBrickWall), depth_left_mm, {43, 31, 50, 3.8}),
      extreme(8, "1,000 m/s at 90 loose bricks: energy gained", "", none, 1e-3, shot_at(kBricks),
              &Run::energy_gained, {0.0001, 0.0001, 0.0001, 0.0001}),
      extreme(8, "1,000 m/s at 90 loose bricks: overlap left", "mm", "rigid", 50, shot_at(kBricks),
              Measure([](const Preset& preset) {
                return mean_of_seeds(shot_at(kBricks)(preset), depth_left_mm);
              }),
              {35, 16, 10, 3.2}),
  };
}

}  // namespace sunder::truths
