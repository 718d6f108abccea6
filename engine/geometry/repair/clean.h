// The first tier of repair: joins vertices and removes degenerate and duplicate polygons.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Returns twice the area of a polygon times its unit normal (Newell), in m².
Vec3 double_area(const RawMesh& mesh, std::size_t polygon);
/// Calls `rewrite` for every polygon with the indices of its corners, and replaces its corners by
/// those that `rewrite` leaves. A polygon without corners is removed.
void rewrite_polygons(
    RawMesh& mesh,
    const std::function<void(std::size_t polygon, std::vector<std::uint32_t>& corners)>& rewrite);
/// Appends a polygon of a group, with zero normals and texture coordinates if the mesh has these.
void append_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices, std::uint32_t group);
/// Reverses the corners of a polygon, so that it faces the other way.
void reverse_polygon(RawMesh& mesh, std::size_t polygon);
/// Removes vertices that no polygon uses.
void drop_unused_vertices(RawMesh& mesh);

/// Joins vertices of exactly equal position. Returns the number of vertices removed.
std::size_t join_identical(RawMesh& mesh);
/// Joins the given vertices within `tolerance_m` of each other. Returns the number of joins.
std::size_t join_close(RawMesh& mesh, std::span<const std::uint32_t> vertices, double tolerance_m);
/// Returns the pairs of vertices at most `distance_m` apart that no chain of edges as short joins.
std::vector<std::array<std::uint32_t, 2>> find_twins(const RawMesh& mesh, double distance_m);
/// Joins the vertices of such pairs. Returns the number of joins.
std::size_t join_twins(RawMesh& mesh, double distance_m);
/// Removes repeated corners, spikes and degenerate polygons. Returns how many polygons it removed.
std::size_t drop_degenerate(RawMesh& mesh);
/// Removes polygons with the vertices and orientation of another; those of opposite orientation
/// only if more than a quarter of the mesh is double-sided, since otherwise they belong to two
/// solids that touch. Returns the number of polygons removed.
std::size_t drop_duplicates(RawMesh& mesh);
/// A vertex to insert into an edge. Half-edge c goes from corner c to the polygon's next corner.
struct Insertion {
  std::uint32_t half_edge;
  double along;  ///< Position from the start of the half-edge, in any unit.
  std::uint32_t vertex;
  auto operator<=>(const Insertion&) const = default;
};
/// Inserts vertices, sorted, into edges. Normals and texture coordinates are interpolated.
void insert_in_edges(RawMesh& mesh, const std::vector<Insertion>& sorted);
/// Inserts ends of open edges into other open edges on which they lie (T-junctions). Returns the
/// number of insertions; 0 if there are too many candidates.
std::size_t join_t_junctions(RawMesh& mesh, std::span<const std::uint32_t> open_half_edges,
                             double tolerance_m);

}  // namespace sunder
