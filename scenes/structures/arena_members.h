// The members of an arena: columns, balusters, statues, arches. Internal to the arena.
//
// Members are made in a frame of their own, upright on y = 0 unless stated otherwise, and are
// placed in their bay by append_moved().
#pragma once

#include <vector>

#include "engine/base/trigonometry.h"
#include "engine/model/compound.h"
#include "scenes/structures/loft.h"

namespace sunder::scenes {

using Parts = std::vector<Part>;

/// Tessellation and material of curved members.
struct StoneOptions {
  int detail = 28;  ///< Segments of a circle.
  MaterialIndex stone;

  /// Returns the number of segments of one curve of a profile.
  int arc() const { return detail < 32 ? 1 + detail / 16 : detail / 10; }
};

/// Appends members to `parts`, moved rigidly by `pose`.
void append_moved(const Pose& pose, Parts members, Parts& parts);
/// Returns the frame at the origin that is rotated about y by an angle.
Pose radial_frame(double angle_rad);
/// Returns the frame with its origin at (x, y, z) of the frame radial_frame(angle_rad).
Pose radial_frame(double angle_rad, double x, double y, double z);

/// Returns a box with two opposite corners.
Part slab(const Vec3& min, const Vec3& max, MaterialIndex material);
/// Returns a block on a rectangular plan, |x| <= half_x and z0 <= z <= z1, with a profile of
/// (projection, height) on three sides; the back is flat at `z0`.
Part moulded_block(double half_x, double z0, double z1, const std::vector<Vec2>& profile,
                   MaterialIndex material);

struct Column {
  double radius_m = 0.27;
  double height_m = 4;
  double pedestal_m = 0.7;
  int drums = 3;
};
/// Returns a fluted column on a base, under a capital; its square blocks are 3 radii wide.
Parts column(const Column& column, const StoneOptions& options);
Part baluster(double height_m, const StoneOptions& options);
Part urn(double height_m, const StoneOptions& options);
/// Returns a figure in a long robe that faces +z.
Part statue(double height_m, const StoneOptions& options);

/// An arch in a wall, with the wall over it up to `top_m`. The opening is `2 * radius_m` wide, the
/// springing is at y = 0, and the arch extends along z from `back` to `front`.
struct ArchedWall {
  double radius_m = 1;
  double ring_m = 0.3;
  double top_m = 1.6;
  double back = -1, front = 0;
  int voussoirs = 9;

  double outer_m() const { return radius_m + ring_m; }
  double shoulder_x() const;  ///< Edge of the wall over the arch, above shoulder_y().
  double shoulder_y() const;
};
/// Returns voussoirs of `options.stone` with a moulding in front, under spandrels of `wall`.
Parts arched_wall(const ArchedWall& arch, const StoneOptions& options, MaterialIndex wall);

/// The sector between two radii, centred on the z-axis; makes parts from one radius to the other.
class Bay {
 public:
  explicit Bay(double half_rad) : half_rad_(half_rad), half_(sin_cos(half_rad)) {}

  /// Returns half the width of the sector at z, less a strip of `inset_m` at either radius.
  double half_width(double z, double inset_m = 0) const {
    return (z * half_.sin - inset_m) / half_.cos;
  }
  double cosine() const { return half_.cos; }

  /// Returns a straight block between z0 and z1.
  Part bar(double z0, double z1, double bottom, double top, MaterialIndex material) const;
  /// Returns the sweep of a profile of (radius, height), its corners counter-clockwise, along the
  /// arc. With `flat_back`, corners at the least radius stay on a straight line.
  Part ring(const Profile& profile, const StoneOptions& options, bool flat_back = false) const;

 private:
  double half_rad_;
  SinCos half_;
};

}  // namespace sunder::scenes
