// The first tier of repair: vertices that are one, and faces that are none.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Twice the area of a polygon times its normal (Newell).
Vec3 double_area(const RawMesh& mesh, std::size_t polygon);
/// Replaces every polygon by those that `rewrite` leaves of its corners, given as indices into the
/// mesh's corners; no corners, no polygon.
void rewrite_polygons(
    RawMesh& mesh,
    const std::function<void(std::size_t polygon, std::vector<std::uint32_t>& corners)>& rewrite);
/// Appends a polygon with the group of another, without attributes.
void append_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices, std::uint32_t group);
/// Turns its corners' order round, so that it faces the other way.
void reverse_polygon(RawMesh& mesh, std::size_t polygon);
/// Drops vertices that no polygon has.
void drop_unused_vertices(RawMesh& mesh);

/// Joins vertices of exactly the same position; returns how many went.
std::size_t join_identical(RawMesh& mesh);
/// Joins those of the given vertices that lie within `tolerance_m` of one another.
std::size_t join_close(RawMesh& mesh, std::span<const std::uint32_t> vertices, double tolerance_m);
/// Drops repeated corners, spikes and polygons without area; returns how many polygons went.
std::size_t drop_degenerate(RawMesh& mesh);
/// Drops polygons that repeat another's vertices, with the same sense; of opposite sense only if
/// the mesh is double-sided throughout (else they are two solids that touch).
std::size_t drop_duplicates(RawMesh& mesh);
/// A vertex to be put into an edge. Half-edge c goes from corner c to the next.
struct Insertion {
  std::uint32_t half_edge;
  double along;  ///< From the half-edge's start, in any unit.
  std::uint32_t vertex;
  auto operator<=>(const Insertion&) const = default;
};
/// Puts vertices into edges; texture coordinates and normals are between those of the edge's ends.
void insert_in_edges(RawMesh& mesh, const std::vector<Insertion>& sorted);
/// Puts open vertices that lie on open edges into those edges; returns how many were put.
std::size_t join_t_junctions(RawMesh& mesh, std::span<const std::uint32_t> open_half_edges,
                             double tolerance_m);

}  // namespace sunder
