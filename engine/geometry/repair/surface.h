// The second tier of repair: adjacency across edges, consistent orientation, and shells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// A mesh with paired half-edges. Half-edge c goes from corner c to the polygon's next corner.
struct Surface {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  RawMesh mesh;
  std::vector<std::uint32_t> polygon;  ///< Polygon of each half-edge.
  std::vector<std::uint32_t> twin;     ///< Opposite half-edge; kNone if the edge is open.

  /// Returns the half-edge after c around its polygon.
  std::uint32_t next(std::uint32_t c) const {
    const RawMesh::Polygon& p = mesh.polygons[polygon[c]];
    return c + 1 < p.first_corner + p.corner_count ? c + 1 : p.first_corner;
  }
  /// Returns the half-edge before c around its polygon.
  std::uint32_t previous(std::uint32_t c) const {
    const RawMesh::Polygon& p = mesh.polygons[polygon[c]];
    return c > p.first_corner ? c - 1 : c + p.corner_count - 1;
  }
  /// Returns the start of half-edge c.
  const Vec3& point(std::uint32_t c) const { return mesh.vertices[mesh.corners[c]]; }
  /// Returns the half-edges without a twin, ascending.
  std::vector<std::uint32_t> open_half_edges() const;
};

/// Numbers of edges with faults.
struct EdgeFaults {
  std::size_t open = 0;          ///< Edges of one polygon.
  std::size_t non_manifold = 0;  ///< Edges of more than two polygons.
  std::size_t inconsistent = 0;  ///< Edges whose two polygons are oppositely oriented.
  bool any() const { return open + non_manifold + inconsistent > 0; }
};

/// Returns the numbers of faulty edges of a mesh.
EdgeFaults edge_faults(const RawMesh& mesh);
/// Flips polygons, of least area in each patch, so that neighbours agree; returns their number.
std::size_t orient(RawMesh& mesh);
/// Pairs opposite half-edges of each edge. At edges of more than two polygons, two polygons are
/// paired if there is solid between them, so that solids that touch are separated.
Surface pair_edges(RawMesh mesh);
/// Gives each fan of polygons around a vertex its own vertex. Returns the number of vertices added.
std::size_t split_vertices(Surface& surface);
/// Inserts a vertex into edges that a surface has more than once, so that two vertices identify an
/// edge, and pairs the edges again. Returns the number of vertices inserted.
std::size_t divide_repeated_edges(Surface& surface);
/// Returns the number of each polygon's shell (set connected by edges), in the order of their first
/// polygons. `count` becomes the number of shells.
std::vector<std::uint32_t> shells_of(const Surface& surface, std::uint32_t& count);
/// Returns the signed volume in m³ that the polygons of each part enclose; valid for closed parts.
std::vector<double> volumes(const RawMesh& mesh, const std::vector<std::uint32_t>& part,
                            std::uint32_t count);

}  // namespace sunder
