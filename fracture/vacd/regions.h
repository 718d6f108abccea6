// Convex regions of space, and the islands of a mesh in each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {

/// A connected part of a mesh, and the convex region it lies in. Faces of the region that other
/// regions meet have names; its outermost ones have none.
struct VacdPiece {
  ConvexPolyhedron region;
  PolygonMesh mesh;
  std::uint32_t shell = 0;  ///< Which of the mesh's shells it is of.

  /// Whether the mesh is the region itself: no part of the original surface is in it.
  bool is_internal() const;
};

/// Names planes that no other part of a compound has.
class PlaneNames {
 public:
  /// One more.
  PlaneId next() { return {2 * ++used_}; }
  /// Takes note that so many have been given by others, from used() on.
  void use(std::uint64_t count) { used_ += count; }
  /// How many there are so far.
  std::uint64_t used() const { return used_; }

 private:
  std::uint64_t used_ = 0;
};

/// Distances up to this are as good as none, for a mesh in that box.
double region_tolerance(const Box& box);

/// The pieces of a mesh in the Voronoi cells of `nodes`; in one region without any. Those of one
/// cell follow each other.
std::vector<VacdPiece> voronoi_pieces(const PolygonMesh& mesh, std::span<const Vec3> nodes,
                                      PlaneNames& names);

/// The region clipped to fit its mesh (paper 4.2); an internal piece's as it is. New faces, and the
/// region's outermost ones, are left without names.
ConvexPolyhedron fitted_region(const VacdPiece& piece, const Fit& fit);

/// Whether a polyhedron shows all that a mesh does: the same solid, flat-shaded, without texture.
bool shows_all(const ConvexPolyhedron& polyhedron, const PolygonMesh& mesh);

}  // namespace sunder::fracture
