// Clipping of watertight meshes of general polygons by planes (paper 3.3).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/cut_edge.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Scratch memory of clip(), for reuse by one thread.
struct MeshClipScratch {
  /// A maximal sequence of inside corners of a contour, between two edges that cross the plane.
  struct Run {
    std::uint32_t contour;
    std::uint32_t first, count;  ///< First corner within the contour, number of corners (cyclic).
    std::uint32_t entry, exit;   ///< Numbers of the crossings before and after the run.
    std::uint32_t next;          ///< The run that follows along the cut line.
  };
  std::vector<double> distances;
  std::vector<std::uint8_t> outside;      ///< 1 if outside, for each vertex.
  std::vector<std::uint32_t> new_of_old;  ///< New number of each vertex.
  EdgeCrossings crossings;
  std::vector<std::uint32_t> cap_next;  ///< Next crossing around the cap, for each crossing.
  std::vector<Run> runs;                ///< Runs of the current face.
  std::vector<std::pair<double, std::uint32_t>> along;  ///< Position on the cut line and run.
  std::vector<std::uint32_t> entry_order;               ///< Runs by the position of their entry.
};

/// Clips a watertight mesh by a plane: `result` becomes the part with plane.distance <= 0 if the
/// return value is kCut, and is unspecified otherwise. It is watertight whatever the rounding,
/// because topology depends only on the sides of the vertices. Vertices within `tolerance_m` of the
/// plane are inside for an even id and outside for an odd id, so the parts cut by (plane, id) and
/// (plane.flipped(), id.opposite()) are complementary and share vertices bit for bit.
///
/// The cap is the last face; it has any number of contours, `id`, kInterior, and texture
/// coordinates in metres of the rest frame. Normals and texture coordinates are interpolated along
/// cut edges.
PlaneSide clip(const PolygonMesh& mesh, const Plane& plane, PlaneId id, double tolerance_m,
               PolygonMesh& result, MeshClipScratch& scratch);

}  // namespace sunder
