// The second tier of repair: which polygons meet at which edge, which way they face, and what
// hangs together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// A mesh with its edges paired. Half-edge c goes from corner c to the polygon's next corner.
struct Surface {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  RawMesh mesh;
  std::vector<std::uint32_t> polygon;  ///< Of each half-edge.
  std::vector<std::uint32_t> twin;     ///< The half-edge back, across the edge; kNone where open.

  /// The half-edges after and before c around its polygon.
  std::uint32_t next(std::uint32_t c) const {
    const RawMesh::Polygon& p = mesh.polygons[polygon[c]];
    return c + 1 < p.first_corner + p.corner_count ? c + 1 : p.first_corner;
  }
  std::uint32_t previous(std::uint32_t c) const {
    const RawMesh::Polygon& p = mesh.polygons[polygon[c]];
    return c > p.first_corner ? c - 1 : c + p.corner_count - 1;
  }
  /// Where half-edge c starts.
  const Vec3& point(std::uint32_t c) const { return mesh.vertices[mesh.corners[c]]; }
  /// Those without a twin, ascending.
  std::vector<std::uint32_t> open_half_edges() const;
};

/// What is wrong with the edges of a mesh.
struct EdgeFaults {
  std::size_t open = 0;          ///< Edges with one polygon.
  std::size_t crowded = 0;       ///< Edges with more than two.
  std::size_t inconsistent = 0;  ///< Edges whose two polygons face opposite ways.
  bool any() const { return open + crowded + inconsistent > 0; }
};

/// Of all edges of a mesh.
EdgeFaults edge_faults(const RawMesh& mesh);
/// Flips polygons so that neighbours agree, fewest (by area) of each patch; returns how many.
std::size_t orient(RawMesh& mesh);
/// Pairs the half-edges that run opposite ways along an edge. Where more than two meet, those are
/// paired that bound solid between them, so that solids that touch come apart.
Surface pair_edges(RawMesh mesh);
/// Gives each fan of polygons around a vertex a vertex of its own; returns how many were added.
std::size_t split_vertices(Surface& surface);
/// Puts a new vertex into edges that a surface passes more than once, so that every edge is told by
/// its ends; returns how many. The edges are paired afterwards.
std::size_t part_edges(Surface& surface);
/// The number of each polygon's shell (what hangs together by edges), in the order of polygons.
std::vector<std::uint32_t> shells_of(const Surface& surface, std::uint32_t& count);
/// The signed volume that the polygons of each part enclose; meaningful where a part is closed.
std::vector<double> volumes(const RawMesh& mesh, const std::vector<std::uint32_t>& part,
                            std::uint32_t count);

}  // namespace sunder
