// Time in the running world. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/model/scene.h"

namespace sunder {

struct Clock {
  double dt_s = 0;
  int substeps = 1;
  int steps_per_frame = 1;
  std::uint64_t step = 0;  ///< Number of the current step.
  std::uint64_t frame = 0;

  explicit Clock(const Accuracy& accuracy)
      : dt_s(accuracy.dt_s),
        substeps(accuracy.substeps),
        steps_per_frame(std::max(1, static_cast<int>(std::lround(1.0 / 60 / dt_s)))) {}

  double time_s() const { return static_cast<double>(step) * dt_s; }
  double frame_s() const { return steps_per_frame * dt_s; }
  /// Time ahead for which speculative contacts are found and impacts decided. It is one substep
  /// more than the step, as the last substep of a solve stops bodies that would touch within one
  /// substep more.
  double horizon_s() const { return dt_s * (1 + 1.0 / substeps); }
  /// Returns true if an event at this time happens in the current step.
  bool is_due(double at_s) const { return at_s <= time_s() + 0.5 * dt_s; }
  /// Time of the frame before the current step.
  double elapsed_s() const {
    return static_cast<double>(step % static_cast<std::uint64_t>(steps_per_frame)) * dt_s;
  }
  /// Returns true if the current step is the last of its frame.
  bool ends_frame() const { return (step + 1) % static_cast<std::uint64_t>(steps_per_frame) == 0; }
};

}  // namespace sunder
