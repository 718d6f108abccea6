// Members that run round an arena, or its stand, from one radius to another. Internal to the arena.
//
// A bay lies between two radii, its middle at z; it is `half_rad` wide to either side.
#pragma once

#include "engine/base/trigonometry.h"
#include "scenes/structures/arena_members.h"

namespace sunder::scenes {

class Bay {
 public:
  explicit Bay(double half_rad) : half_rad_(half_rad), half_(sin_cos(half_rad)) {}

  /// How far to either side of the middle the radii are at z, less `short_m` of them.
  double flank(double z, double short_m = 0) const {
    return (z * half_.sin - short_m) / half_.cos;
  }
  double cosine() const { return half_.cos; }

  /// Straight from radius to radius, as a wall is.
  Part bar(double z0, double z1, double bottom, double top, MaterialIndex material) const;
  /// Along an arc about the middle of the arena, the profile one of (radius, height), its corners
  /// counter-clockwise; `flat_back` leaves those at the least radius straight.
  Part ring(const Profile& profile, const Chisel& chisel, bool flat_back = false) const;

 private:
  double half_rad_;
  SinCos half_;
};

/// A temple on a round stand, its middle at the origin.
struct Stand {
  double radius_m = 6;
  double height_m = 2.2;
  double column_m = 4.4;
  int columns = 12;
};
Parts stand(const Stand& stand, const Chisel& chisel, MaterialIndex wall);

}  // namespace sunder::scenes
