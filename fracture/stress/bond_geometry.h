// Geometry of the contact area of a bond, as the stress solve needs it.
#pragma once

#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Geometry of the overlap of a bond's two faces. For convexes with visual meshes, its shape is
/// that of the smaller of their caps, and its area that of the bond.
struct BondGeometry {
  Vec3 centroid_R = Vec3::Zero();
  Vec3 normal_R = Vec3::UnitY();  ///< Unit normal from convex a to convex b.
  double area_m2 = 0;
  Mat3 second_moment = Mat3::Zero();  ///< ∫ r rᵀ dA about the centroid, m⁴.
  double reach_m = 0;                 ///< Distance from the centroid to the farthest corner.

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// Returns the geometry of a bond of the compound; the area is 0 if the faces do not overlap.
BondGeometry bond_geometry(const Compound& compound, const Bond& bond);
/// Returns the corners of the overlap, or of the smaller cap.
std::vector<Vec3> bond_corners(const Compound& compound, const Bond& bond);

}  // namespace sunder::fracture
