// What an arena is put together from: columns, balusters, statues, arches. Internal to the arena.
//
// Members are made in a frame of their own, upright on y = 0 unless it says otherwise, and are put
// into their bay by moved_to().
#pragma once

#include <span>
#include <vector>

#include "engine/base/trigonometry.h"
#include "engine/model/compound.h"
#include "scenes/structures/loft.h"

namespace sunder::scenes {

using Parts = std::vector<Part>;

/// How finely what is curved is drawn, and what of.
struct Chisel {
  int detail = 28;  ///< Segments of a circle.
  MaterialIndex stone;

  int arc() const { return detail < 32 ? 1 + detail / 16 : detail / 10; }  ///< Of a stroke.
};

/// Appends parts, moved rigidly.
void move_to(const Pose& pose, Parts members, Parts& parts);
/// The frame whose z-axis lies at an angle about y.
Pose ray(double angle_rad);
/// A place in it.
Pose ray(double angle_rad, double x, double y, double z);

/// A box with two opposite corners.
Part slab(const Vec3& min, const Vec3& max, MaterialIndex material);
/// A block on a square or oblong plan, as a profile of (how far it stands out, height) says; its
/// back stays flat at `z0`.
Part moulded_block(double half_x, double z0, double z1, const std::vector<Vec2>& profile,
                   MaterialIndex material);

struct Column {
  double radius_m = 0.27;
  double height_m = 4;
  double pedestal_m = 0.7;
  int drums = 3;
};
/// A fluted column on a base, under a capital; what of it is square is 3 radii wide.
Parts column(const Column& column, const Chisel& chisel);
Part baluster(double height_m, const Chisel& chisel);
Part urn(double height_m, const Chisel& chisel);
/// A figure in a long robe, which looks along z.
Part statue(double height_m, const Chisel& chisel);

/// An arch in a wall: its opening is `2 * radius_m` wide, its springing at y = 0; it runs along z
/// from `back` to `front`, and what is about it up to `top_m` is part of it.
struct ArchedWall {
  double radius_m = 1;
  double ring_m = 0.3;
  double top_m = 1.6;
  double back = -1, front = 0;
  int voussoirs = 9;

  double outer_m() const { return radius_m + ring_m; }
  double shoulder_x() const;  ///< The wall begins there above shoulder_y().
  double shoulder_y() const;
};
/// Voussoirs of `chisel.stone` with a moulding before them, under spandrels of `wall`.
Parts arched_wall(const ArchedWall& arch, const Chisel& chisel, MaterialIndex wall);

/// Between two radii of an arena, its middle at z: what runs round it there, from one to the other.
class Bay {
 public:
  explicit Bay(double half_rad) : half_rad_(half_rad), half_(sin_cos(half_rad)) {}

  /// How far to either side of the middle the radii are at z, less `short_m` of them.
  double flank(double z, double short_m = 0) const { return (z * half_.sin - short_m) / half_.cos; }
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

}  // namespace sunder::scenes
