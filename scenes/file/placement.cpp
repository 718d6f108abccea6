#include "scenes/file/placement.h"

#include <cstddef>
#include <string>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"

namespace sunder::scenes {
namespace {

constexpr std::string_view kMirrors[] = {"none", "x", "y", "z", "xz"};
constexpr std::size_t kMaxCopies = 20000;

Keys<PlacementTable> make_placement_keys() {
  constexpr Range kPlace = ranges::kPlace_m, kTurn{-6.2832, 6.2832};
  return {
      "[[solid]], [[solid.part]], [[body]]",
      {key<&PlacementTable::position>("position", "m", kPlace,
                                      "Position of the middle of the foot."),
       key<&PlacementTable::rotation_rad>(
           "rotation_rad", "rad", kTurn,
           "Rotation about the axes x, then y, then z, through the middle of the foot."),
       table_key("repeat", "Copies; each of several tables repeats all copies of those before it."),
       choice<&PlacementTable::mirror>("mirror", kMirrors,
                                       "Adds mirror images of all copies along this axis; xz: "
                                       "along x, then all of them along z."),
       key<&PlacementTable::mirror_at_m>("mirror_at_m", "m", kPlace,
                                         "Point of the mirror plane, or of both.")}};
}

Keys<RepeatTable> make_repeat_keys() {
  constexpr Range kPlace = ranges::kPlace_m, kTurn{-6.2832, 6.2832};
  return {
      "[solid.repeat], [solid.part.repeat], [body.repeat]",
      {key<&RepeatTable::count>("count", "", Range{1, kMaxCopies},
                                "Number of copies, including the first.")
           .must(),
       key<&RepeatTable::step_m>("step_m", "m", kPlace, "Displacement from each copy to the next."),
       key<&RepeatTable::turn_rad>(
           "turn_rad", "rad", kTurn,
           "Rotation from each copy to the next, about the vertical axis through center_m."),
       key<&RepeatTable::center_m>("center_m", "m", kPlace, "Centre of the ring.")}};
}

/// Appends the copies of one `repeat` table.
void repeat(const Value& table, std::vector<Copy>& copies) {
  RepeatTable given;
  read(repeat_keys(), table, {}, given);
  const std::size_t before = copies.size();
  if (given.count > 1 && given.step_m.isZero() && given.turn_rad == 0) {
    throw InputError(table.where + ": repeat puts all copies at one place; add step_m, " +
                     "turn_rad or turn_deg");
  }
  if (before * given.count > kMaxCopies) {
    throw InputError(table.where + ": " + std::to_string(before * given.count) +
                     " copies by repeat; allowed: at most " + std::to_string(kMaxCopies));
  }
  for (std::uint32_t k = 1; k < given.count; ++k) {
    const Quat turn = rotation(Vec3(0, k * given.turn_rad, 0));
    for (std::size_t i = 0; i < before; ++i) {
      Copy copy = copies[i];
      if (given.turn_rad != 0) {
        copy.X_FM.position = given.center_m + turn * (copy.X_FM.position - given.center_m);
        copy.X_FM.rotation = turn * copy.X_FM.rotation;
        copy.turn = turn.toRotationMatrix() * copy.turn;
      }
      copy.X_FM.position += k * given.step_m;
      copies.push_back(copy);
    }
  }
}

/// Appends copies mirrored along an axis at the coordinate `at_m`. A rotation followed by this
/// reflection equals the model's own reflection along x followed by another rotation.
void mirror(int axis, double at_m, std::vector<Copy>& copies) {
  const std::size_t before = copies.size();
  for (std::size_t i = 0; i < before; ++i) {
    Copy copy = copies[i];
    Quat& q = copy.X_FM.rotation;
    q = Quat(q.w(), q.x(), -q.y(), -q.z());
    if (axis == 1) q = Quat(0, 0, 0, 1) * q;
    if (axis == 2) q = Quat(0, 0, 1, 0) * q;
    copy.X_FM.position[axis] = 2 * at_m - copy.X_FM.position[axis];
    copy.turn.row(axis) *= -1;
    copy.mirrored = !copy.mirrored;
    copies.push_back(copy);
  }
}

}  // namespace

const Keys<PlacementTable>& placement_keys() {
  static const Keys<PlacementTable> kKeys = make_placement_keys();
  return kKeys;
}

const Keys<RepeatTable>& repeat_keys() {
  static const Keys<RepeatTable> kKeys = make_repeat_keys();
  return kKeys;
}

Quat rotation(const Vec3& angles_rad) {
  Quat q = Quat::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const SinCos half = sin_cos(angles_rad[axis] / 2);
    const Vec3 v = half.sin * Vec3::Unit(axis);
    q = Quat(half.cos, v.x(), v.y(), v.z()) * q;
  }
  return q.normalized();
}

std::vector<Copy> read_copies(const Value& table, std::string_view name) {
  PlacementTable given;
  read_keys(table, name, placement_keys().keys, {}, &given);
  std::vector<Copy> copies{{{given.position, rotation(given.rotation_rad)}}};
  if (const Value* value = find(table, "repeat")) {
    if (const Array* several = std::get_if<Array>(&value->data)) {
      for (const Value& one : *several) repeat(one, copies);
    } else {
      repeat(*value, copies);
    }
  }
  const Mirror along = given.mirror;
  const Vec3& at = given.mirror_at_m;
  if (along == Mirror::kX || along == Mirror::kXZ) mirror(0, at.x(), copies);
  if (along == Mirror::kY) mirror(1, at.y(), copies);
  if (along == Mirror::kZ || along == Mirror::kXZ) mirror(2, at.z(), copies);
  return copies;
}

}  // namespace sunder::scenes
