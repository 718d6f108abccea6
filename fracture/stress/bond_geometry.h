// Where two convexes touch and how the touching area is shaped: what the stress solve needs to
// know of a bond beyond its area.
#pragma once

#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// The polygon that the two faces of a bond have in common; of convexes with a visual mesh, what
/// their meshes' caps have in common, shaped as the smaller cap.
struct BondGeometry {
  Vec3 centroid_R = Vec3::Zero();
  Vec3 normal_R = Vec3::UnitY();  ///< Unit, from convex a to convex b.
  double area_m2 = 0;
  Mat3 second_moment = Mat3::Zero();  ///< ∫ r rᵀ dA about the centroid, m⁴.
  double reach_m = 0;                 ///< From the centroid to the farthest corner.
};

/// Of a bond of the compound; without area where the faces no longer overlap.
BondGeometry bond_geometry(const Compound& compound, const Bond& bond);
/// The corners of that polygon, or of the smaller cap.
std::vector<Vec3> bond_corners(const Compound& compound, const Bond& bond);

}  // namespace sunder::fracture
