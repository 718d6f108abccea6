// Convex regions of space, and the islands of a mesh in each of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// A connected part of a mesh and the convex region that contains it. Faces shared with other
/// regions have plane ids; the outermost faces have none.
struct VacdPiece {
  ConvexPolyhedron region;
  PolygonMesh mesh;
  std::uint32_t shell = 0;  ///< Index of the mesh's shell.

  /// Returns true if the mesh fills the region: it has no part of the original surface.
  bool is_inside_mesh() const;
};

/// Allocates plane ids that are unique in a compound.
class PlaneIdAllocator {
 public:
  /// Returns a new id.
  PlaneId next() { return {2 * ++used_}; }
  /// Reserves `count` ids that were assigned elsewhere, starting at used().
  void reserve(std::uint64_t count) { used_ += count; }
  /// Returns the number of ids in use.
  std::uint64_t used() const { return used_; }

 private:
  std::uint64_t used_ = 0;
};

/// Returns the distance below which geometry in a box counts as coincident.
double region_tolerance(const Box& box);

/// Returns the pieces of a mesh in the Voronoi cells of `nodes`, or in one region if there are
/// none. Pieces of one cell are consecutive.
std::vector<VacdPiece> voronoi_pieces(const PolygonMesh& mesh, std::span<const Vec3> nodes,
                                      PlaneIdAllocator& ids);

/// Returns the region clipped to fit its mesh (paper 4.2), or the region itself for an internal
/// piece. New faces and outermost faces have no ids.
ConvexPolyhedron fitted_region(const VacdPiece& piece, const Fit& fit);

/// Returns true if a polyhedron renders like a mesh: equal volume, flat shading and no texture.
bool renders_like(const ConvexPolyhedron& polyhedron, const PolygonMesh& mesh);

}  // namespace sunder::fracture
