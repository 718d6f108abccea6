// Where something is taken, and when: keys in time, and what lies between them.
#pragma once

#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Where something is at a time, seen from where it stood.
struct PathKey {
  double time_s = 0;
  Vec3 shift_W = Vec3::Zero();
  Vec3 turn_W = Vec3::Zero();  ///< Rotation vector; more than a turn is one.
};

/// Starts at time 0 where it stood; goes through its keys, whose times ascend from there; stays at
/// the last, or begins again.
struct Path {
  std::vector<PathKey> keys;
  /// Velocities are continuous, 0 at both ends of what does not loop, and overshoot no key; what
  /// goes equally fast from key to key goes so between them. Else straight from key to key.
  bool smooth = true;
  bool loops = false;  ///< The last key is where it stood, but for whole turns.

  PathKey at(double time_s) const;
};

}  // namespace sunder
