// What time it is in the running world. Internal to engine/world.
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
  std::uint64_t step = 0;  ///< The one under way.
  std::uint64_t frame = 0;

  explicit Clock(const Accuracy& accuracy)
      : dt_s(accuracy.dt_s),
        substeps(accuracy.substeps),
        steps_per_frame(std::max(1, static_cast<int>(std::lround(1.0 / 60 / dt_s)))) {}

  double time_s() const { return static_cast<double>(step) * dt_s; }
  double frame_s() const { return steps_per_frame * dt_s; }
  /// How far ahead approaches are looked for, and decided: a solve's last substep stops what would
  /// meet within one substep more.
  double horizon_s() const { return dt_s * (1 + 1.0 / substeps); }
  /// Whether what is due at that time happens in this step.
  bool is_due(double at_s) const { return at_s <= time_s() + 0.5 * dt_s; }
  /// How much of the frame has passed before this step.
  double elapsed_s() const {
    return static_cast<double>(step % static_cast<std::uint64_t>(steps_per_frame)) * dt_s;
  }
  /// Whether this step is the last of its frame.
  bool ends_frame() const { return (step + 1) % static_cast<std::uint64_t>(steps_per_frame) == 0; }
};

}  // namespace sunder
