// Where a solid, a body or a part of a compound is put, and how often: in rows, rings and mirrors.
//
// Read first: read_copies().
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

enum class Mirror { kNone, kX, kY, kZ, kXZ };

/// The keys that say where.
struct PlacementTable {
  Vec3 position = Vec3::Zero();
  Vec3 rotation_rad = Vec3::Zero();
  Mirror mirror = Mirror::kNone;
  Vec3 mirror_at_m = Vec3::Zero();
};
const Keys<PlacementTable>& placement_keys();

/// The keys of `repeat`.
struct RepeatTable {
  std::uint32_t count = 0;
  Vec3 step_m = Vec3::Zero();
  double turn_rad = 0;
  Vec3 center_m = Vec3::Zero();
};
const Keys<RepeatTable>& repeat_keys();

/// One of what a table asks for: a model in its own frame M, which first may be mirrored at x = 0,
/// in the frame F that it is put into.
struct Copy {
  Pose X_FM;
  bool mirrored = false;
  /// From directions in F of the first copy to this one's; a reflection if `mirrored`.
  Mat3 turn = Mat3::Identity();

  Vec3 velocity(const Vec3& of_first) const { return turn * of_first; }
  /// What turns, turns the other way in a mirror.
  Vec3 angular_velocity(const Vec3& of_first) const {
    return mirrored ? Vec3(-(turn * of_first)) : Vec3(turn * of_first);
  }
};

/// All copies that a table called `name` asks for: the first is where it says; each `repeat`
/// repeats all there are before it, and `mirror` mirrors all of them. Throws InputError.
std::vector<Copy> read_copies(const Value& table, std::string_view name);

/// About x, then y, then z.
Quat rotation(const Vec3& angles_rad);

}  // namespace sunder::scenes
