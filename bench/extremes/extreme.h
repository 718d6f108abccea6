// Validation of extreme scenes: results at every preset, and the warnings that a user gets for
// these scenes. Printed by `validation_bench extremes`, asserted by tests/truths, listed in
// docs/extremes.md.
//
// Begin at extreme(). Each file of the folder has the scenes of one theme.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bench/truths/truth.h"
#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder::truths {

using SceneAt = std::function<Scene(const Preset&)>;

/// Measurements of a scene that was simulated through the library from first to last frame.
struct Run {
  FramePtr first, last;
  double energy_gained = 0;   ///< Largest rise of energy above its start, divided by the start.
  double deepest_m = 0;       ///< Largest penetration of any frame.
  double mass_error = 0;      ///< Largest deviation of mass from its start, divided by the start.
  double momentum_error = 0;  ///< Largest FrameReport::momentum_residual.

  /// Returns the final speed of a body of the first frame; infinity if the body is gone.
  double speed_m_s(std::uint64_t key) const;
  /// Returns the largest final displacement of a body of the first frame; infinity if one is gone.
  double largest_displacement_m() const;
  /// Returns the largest penetration of the last frame.
  double final_penetration_m() const;
};
/// Simulates a scene. All measurements are infinite if the state of a body is not finite.
Run run(Scene scene);

/// Returns the scene of a text with the given duration; `set` has KEY=VALUE, as --set.
Scene scene_at(const Preset& preset, const std::string& text, double duration_s,
               std::vector<std::string> set = {});

/// Returns the mean over seeds from 1 on, because results of rubble differ much from seed to seed.
double mean_of_seeds(Scene scene, const std::function<double(const Run&)>& figure, int seeds = 8);

/// Returns a validation case that simulates the scene and measures `figure`.
Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, const std::function<double(const Run&)>& figure,
              const Bounds& bounds);
/// Returns a validation case with any measurement; the scene is the one whose warnings a user gets.
Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, Measure measure, const Bounds& bounds);

Truths mass_extremes();
Truths size_extremes();
Truths step_extremes();
Truths surface_extremes();
Truths speed_extremes();
Truths place_extremes();

/// Returns all extreme cases, in the order of their rows.
Truths all_extremes();

}  // namespace sunder::truths
