// Mitring of a solid's convexes at a section that has bent (engine/geometry/mitre.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/mitre.h"
#include "engine/model/structure.h"

namespace sunder {

/// One side of a section: its convexes and their faces at the section, one element per former bond.
struct BentSide {
  const Structure& structure;
  std::span<const std::uint32_t> slots, faces;
  std::span<const double> areas_m2;  ///< Areas of the bonds.
  SectionEnd end;
  double reach_m = 0;  ///< Distance from the centroid to the farthest point of the section.
};

/// The plane in which both sides of a bent section end, in each side's rest frame. A side whose
/// section covers only part of its faces, such as the flank of a column that carries a girder,
/// stays unchanged, and the other side ends in its plane.
struct MeetingPlane {
  Midplane planes;
  bool ends_a = true, ends_b = true;
  PlaneId of_wall;  ///< Id of the plane on the unchanged side, if there is one.
};

/// Returns the meeting plane, or nothing if the sides are bent too far or both sections cover only
/// part of their faces. X_AB is the pose of b's rest frame in a's.
std::optional<MeetingPlane> meeting_plane(const BentSide& a, const BentSide& b, const Pose& X_AB);

/// A convex that has been cut or extended to the midplane; null: nothing is left of it.
struct Ended {
  ConvexSlot slot;
  ConvexPtr convex;
};

/// Returns the convexes that change, ascending by slot. Convexes of the section are extended to the
/// midplane, and parts of other convexes beyond it are cut off. New faces get the id `id`.
std::vector<Ended> end_side(const BentSide& side, const Plane& midplane, PlaneId id);

}  // namespace sunder
