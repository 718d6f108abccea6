// Placement of solids, bodies and parts of compounds, and their copies in rows, rings and mirrors.
//
// Read first: read_copies().
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// Axis along which copies are mirrored; kXZ: along x, then all of them along z.
enum class Mirror { kNone, kX, kY, kZ, kXZ };

/// The keys of a placement.
struct PlacementTable {
  Vec3 position = Vec3::Zero();
  Vec3 rotation_rad = Vec3::Zero();
  Mirror mirror = Mirror::kNone;
  Vec3 mirror_at_m = Vec3::Zero();
};
const Keys<PlacementTable>& placement_keys();

/// The keys of `repeat`.
struct RepeatTable {
  std::uint32_t count = 0;  ///< Copies, with the first one.
  Vec3 step_m = Vec3::Zero();
  double turn_rad = 0;  ///< From each copy to the next, about the vertical axis through center_m.
  Vec3 center_m = Vec3::Zero();
};
const Keys<RepeatTable>& repeat_keys();

/// One copy of a model. If `mirrored`, the model is reflected at x = 0 in its frame M; then X_FM
/// places M in the frame F of the scene or compound.
struct Copy {
  Pose X_FM;
  bool mirrored = false;
  /// Rotation in F from the first copy to this one; includes a reflection if `mirrored`.
  Mat3 turn = Mat3::Identity();

  /// Returns the velocity of this copy for that of the first.
  Vec3 velocity(const Vec3& of_first) const { return turn * of_first; }
  /// Returns the angular velocity of this copy for that of the first; a reflection reverses it.
  Vec3 angular_velocity(const Vec3& of_first) const {
    return mirrored ? Vec3(-(turn * of_first)) : Vec3(turn * of_first);
  }
};

/// Reads the placement keys of a table, which errors call `name`, and returns its copies: the first
/// at the given pose, then those of each `repeat`, which repeats all copies before it, then those
/// of `mirror`, which mirrors all of them. Throws InputError.
std::vector<Copy> read_copies(const Value& table, std::string_view name);

/// Returns the rotation about the fixed axes x, then y, then z.
Quat rotation(const Vec3& angles_rad);

}  // namespace sunder::scenes
