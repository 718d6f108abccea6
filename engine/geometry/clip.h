// Cutting convex polyhedra by planes (paper 3.1).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/cut_edge.h"

namespace sunder {

/// Reused memory of clip(); one per thread.
struct ClipScratch {
  std::vector<double> distances;
  std::vector<std::uint8_t> sides;        ///< Per vertex.
  std::vector<std::uint32_t> new_of_old;  ///< Per vertex.
  EdgeCrossings crossings;
  std::vector<std::uint32_t> cap_next;  ///< Per new vertex: the cap's edges.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_edges;  ///< Kept, both ends on.
};

/// Keeps the part of a closed `convex` with plane.distance <= 0 in `result` (unspecified unless the
/// answer is kCut). The new face, the last, gets `id` and kInterior (where a sliver as thin as the
/// rounding is cut, it may be several faces or none). Topology follows from the vertices'
/// signs alone (distances within `tolerance_m` of the plane count as on it), so the result is
/// closed whatever the rounding; normals are interpolated along cut edges. A cut edge gives the
/// same bits from either side of the plane and in every convex that has the edge. A convex wholly
/// within tolerance is inside for exactly one of (plane, id) and (plane.flipped(), id.opposite()).
PlaneSide clip(const ConvexPolyhedron& convex, const Plane& plane, PlaneId id, double tolerance_m,
               ConvexPolyhedron& result, ClipScratch& scratch);

}  // namespace sunder
