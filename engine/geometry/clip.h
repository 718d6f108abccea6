// Clipping of convex polyhedra by planes (paper 3.1).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/cut_edge.h"

namespace sunder {

/// Scratch memory of clip(), for reuse by one thread.
struct ClipScratch {
  std::vector<double> distances;
  std::vector<std::uint8_t> sides;        ///< Side of each vertex.
  std::vector<std::uint32_t> new_of_old;  ///< New number of each vertex.
  EdgeCrossings crossings;
  std::vector<std::uint32_t> cap_next;  ///< Next vertex around the cap, for each new vertex.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_edges;  ///< Kept edges on the plane.
};

/// Clips a closed convex by a plane: `result` becomes the part with plane.distance <= 0 if the
/// return value is kCut, and is unspecified otherwise. The cap is the last face and gets `id` and
/// kInterior; it may be several faces or none where the cut part is as thin as rounding errors.
/// Topology depends only on the vertices' signed distances (those within `tolerance_m` count as on
/// the plane), so the result is closed whatever the rounding. Normals are interpolated along cut
/// edges. The new vertex of an edge has the same bits in both parts and in all convexes that share
/// the edge. A convex within tolerance of the plane is inside for exactly one of (plane, id) and
/// (plane.flipped(), id.opposite()).
PlaneSide clip(const ConvexPolyhedron& convex, const Plane& plane, PlaneId id, double tolerance_m,
               ConvexPolyhedron& result, ClipScratch& scratch);

}  // namespace sunder
