// What becomes of a solid's convexes beside a section that has bent (engine/geometry/mitre.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/mitre.h"
#include "engine/model/structure.h"

namespace sunder {

/// One side of a section: its convexes, and which of their faces are of it, per bond that it had.
struct BentSide {
  const Structure& structure;
  std::span<const std::uint32_t> slots, faces;
  std::span<const double> areas_m2;  ///< Of the bonds.
  SectionEnd end;
  double reach_m = 0;  ///< From the centroid to what is farthest in the section.
};

/// The plane in which both sides of a section end once it has bent, as each sees it. Where one of
/// them is but a part of what it is on, as a girder's end on the flank of a column, or a post on
/// its foundation, that stays as it is, and the other ends in its plane.
struct MeetingPlane {
  Midplane planes;
  bool ends_a = true, ends_b = true;
  PlaneId of_wall;  ///< What the plane is called on the side that does not end there, if one.
};

/// Nothing where they are bent too far, or each is but a part of what it is on. B's rest frame has
/// the pose X_AB in a's.
std::optional<MeetingPlane> meeting_plane(const BentSide& a, const BentSide& b, const Pose& X_AB);

/// A convex that ends in the midplane now; null: nothing is left of it.
struct Ended {
  ConvexSlot slot;
  ConvexPtr convex;
};

/// What ends otherwise than it did, ascending. Those of the section are drawn out to the midplane,
/// and what it reaches behind them is cut; the new faces are named `id`.
std::vector<Ended> end_side(const BentSide& side, const Plane& midplane, PlaneId id);

}  // namespace sunder
