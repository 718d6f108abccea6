// Convexes that touch become a compound: coplanar faces get shared plane ids, overlaps bonds.
#pragma once

#include <vector>

#include "engine/world/compound.h"

namespace sunder::fracture {

/// A convex on its way into a compound.
struct Part {
  ConvexPolyhedron polyhedron;
  MaterialIndex material;
  std::uint8_t anchored = 0;  ///< As in Compound: `true` is held from below.
  std::shared_ptr<const PolygonMesh> visual = nullptr;  ///< As in Convex.
};

/// A compound of parts that do not overlap. Faces within `tolerance_m` of one plane share a plane
/// id; touching pairs become bonds.
Compound make_compound(std::vector<Part> parts, double tolerance_m = 1e-6);

}  // namespace sunder::fracture
