// Cutting visual meshes: general polygons, watertight before and after (paper 3.3).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/cut_edge.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

/// Reused memory of clip(); one per thread.
struct MeshClipScratch {
  /// Corners in a row that stay, between the two edges where the contour crosses the plane.
  struct Run {
    std::uint32_t contour;
    std::uint32_t first, count;  ///< Corners of the contour, from `first` on, around.
    std::uint32_t entry, exit;   ///< Crossings.
    std::uint32_t after;         ///< The run that the cut leads on to.
  };
  std::vector<double> distances;
  std::vector<std::uint8_t> outside;      ///< Per vertex.
  std::vector<std::uint32_t> new_of_old;  ///< Per vertex.
  EdgeCrossings crossings;
  std::vector<std::uint32_t> cap_next;                  ///< Per crossing: the cap's edges.
  std::vector<Run> runs;                                ///< Of one face.
  std::vector<std::pair<double, std::uint32_t>> along;  ///< Places of crossings on the cut line.
  std::vector<std::uint32_t> entry_order;
};

/// Keeps the part of a watertight mesh with plane.distance <= 0 in `result` (unspecified unless the
/// answer is kCut): watertight, whatever the rounding, because topology follows from the vertices'
/// sides alone. Vertices within `tolerance_m` of the plane are all inside for an even id and all
/// outside for an odd one, so cuts by (plane, id) and (plane.flipped(), id.opposite()) make up the
/// whole and share their vertices bit for bit. The cap is one face, the last, of any number of
/// contours, with `id`, kInterior and texture coordinates in metres of the rest frame; normals and
/// texture coordinates are interpolated along cut edges.
PlaneSide clip(const PolygonMesh& mesh, const Plane& plane, PlaneId id, double tolerance_m,
               PolygonMesh& result, MeshClipScratch& scratch);

}  // namespace sunder
