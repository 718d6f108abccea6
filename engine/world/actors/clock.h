// Time in the running world. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "engine/model/scene.h"

namespace sunder {

/// Frames follow each other, each of one or more equal steps.
struct Clock {
  double dt_s = 0;  ///< Length of a step of the current frame.
  int substeps = 1;
  int steps_per_frame = 1;  ///< Number of steps of the current frame.
  std::uint64_t step = 0;   ///< Number of the current step.
  std::uint64_t frame = 0;

  /// Frames are 1/60 s long, or a step of `accuracy` if that is longer.
  explicit Clock(const Accuracy& accuracy)
      : dt_s(accuracy.dt_s),
        substeps(accuracy.substeps),
        steps_per_frame(std::max(1, static_cast<int>(std::lround(1.0 / 60 / dt_s)))) {}

  /// Begins a frame of this many steps, each of `of_dt_s`.
  void begin_frame(int steps, double of_dt_s) {
    if (of_dt_s != dt_s) {
      since_s = time_s();
      since_step = step;
    }
    dt_s = of_dt_s;
    steps_per_frame = steps;
    first_step = step;
    ++frame;
  }
  double time_s() const { return since_s + static_cast<double>(step - since_step) * dt_s; }
  double frame_s() const { return steps_per_frame * dt_s; }
  /// Time ahead for which speculative contacts are found and impacts decided. It is one substep
  /// more than the step, as the last substep of a solve stops bodies that would touch within one
  /// substep more.
  double horizon_s() const { return dt_s * (1 + 1.0 / substeps); }
  /// Returns true if an event at this time happens in the current step.
  bool is_due(double at_s) const { return at_s <= time_s() + 0.5 * dt_s; }
  /// Time of the frame before the current step.
  double elapsed_s() const { return static_cast<double>(step - first_step) * dt_s; }
  /// Returns true if the current step is the last of its frame.
  bool ends_frame() const {
    return step + 1 == first_step + static_cast<std::uint64_t>(steps_per_frame);
  }

  static auto fields(auto& self) {
    return std::tie(self.dt_s, self.substeps, self.steps_per_frame, self.step, self.frame,
                    self.since_s, self.since_step, self.first_step);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const {
    constexpr int kMostSteps = 1000000;  // of a frame of the longest time, at the shortest step
    if (!(dt_s >= 1e-6 && dt_s <= 1)) return "dt_s";
    if (substeps < 1 || substeps > 1000) return "substeps";
    if (steps_per_frame < 1 || steps_per_frame > kMostSteps) return "steps_per_frame";
    if (!(since_s >= 0 && since_s < 1e12)) return "since_s";
    if (since_step > step) return "since_step";
    return first_step <= step ? nullptr : "first_step";
  }

  double since_s = 0;            ///< Time at which steps became `dt_s` long.
  std::uint64_t since_step = 0;  ///< First step of this length.
  std::uint64_t first_step = 0;  ///< First step of the current frame.
};

}  // namespace sunder
