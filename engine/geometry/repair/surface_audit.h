// Counts what is wrong with a mesh, as an importer sees it that joins equal points. All figures of
// exported pieces come from here.
#pragma once

#include <cstddef>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Points of a sound surface are farther apart than this, unless short edges join them.
inline constexpr double kTwinDistance_m = 1e-8;

/// Counts of a mesh of triangles, in which points of equal coordinates are one point.
struct SurfaceAudit {
  std::size_t triangles = 0;            ///< Triangles of three different points.
  std::size_t collapsed_triangles = 0;  ///< Triangles with equal corners; no other figure has them.
  /// Edges that unequal numbers of triangles follow in the two directions; 0 if the mesh is closed.
  std::size_t open_edges = 0;
  std::size_t non_manifold_edges = 0;  ///< Edges of more than two triangles.
  /// Pairs of points at most kTwinDistance_m apart that no chain of edges as short joins: one point
  /// was meant.
  std::size_t twin_points = 0;
  /// Closed parts. At an edge of more than two triangles, those with solid between them belong
  /// together.
  std::size_t islands = 0;
  /// Islands of negative volume that are not hollows: the winding number is negative inside them.
  /// A hollow lies in the solid of other islands, whose surface it may touch.
  std::size_t inside_out_islands = 0;
  double inside_out_m3 = 0;  ///< Volume of these islands, positive.
  double volume_m3 = 0;      ///< Signed volume of all islands; valid if no edge is open.

  /// Returns true if the mesh is the surface of a solid: nothing is wrong, and there is volume.
  bool is_sound() const {
    return collapsed_triangles + open_edges + non_manifold_edges + twin_points +
                   inside_out_islands ==
               0 &&
           volume_m3 > 0;
  }
  /// Adds the counts and volumes of another mesh.
  SurfaceAudit& operator+=(const SurfaceAudit& other);
};

/// Counts the faults of a mesh, whose polygons must be triangles. Throws nothing: any indices that
/// a RawMesh may have are counted. Takes n log n steps for n triangles, and n for each island of
/// negative volume.
SurfaceAudit audit_surface(RawMesh mesh);

/// Returns the triangles of a mesh, as they are exported.
RawMesh triangle_mesh(const PolygonMesh& mesh);

}  // namespace sunder
