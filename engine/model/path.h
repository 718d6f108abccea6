// Paths of scripted motion: poses at key times, and interpolation between them.
#pragma once

#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Displacement and rotation at a time, relative to the pose at the start.
struct PathKey {
  double time_s = 0;
  Vec3 shift_W = Vec3::Zero();
  Vec3 rotation_W = Vec3::Zero();  ///< Rotation vector; angles above 2π are several turns.
};

/// A path from the pose at time 0 through all keys, whose times ascend from 0. After the last key
/// it stays there or, if it loops, starts again.
struct Path {
  std::vector<PathKey> keys;
  /// True: velocities are continuous, 0 at both ends unless the path loops, and overshoot no key;
  /// equal speeds from key to key remain constant. False: linear interpolation.
  bool smooth = true;
  /// True: repeats; the last key must equal the start, except for whole turns.
  bool loops = false;

  /// Returns the interpolated key; times outside the path are clamped, or wrapped if it loops.
  PathKey at(double time_s) const;
};

}  // namespace sunder
