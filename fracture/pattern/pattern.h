// Fracture patterns: space divided into convex cells around an impact at the origin (paper 3.1).
//
// Read first: Pattern. A pattern is made once in its own frame P, whose unit is the radius of the
// impact sphere, and is then aligned with any number of impacts (align.h). Each kind has a file:
// voronoi_pattern, web_pattern, block_patterns (grid and bricks), slab_pattern (wood), plug_pattern
// and file_pattern. pattern.cpp has the functions that they share.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/bvh.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/model/breaker.h"
#include "engine/model/material.h"

namespace sunder::fracture {

/// One convex cell of a pattern.
struct Cell {
  /// Face ids are those of the pattern's planes: 2·index + side, side 1 being the flipped plane.
  ConvexPolyhedron polyhedron;
  double volume = 0;
  std::uint32_t color = 0;  ///< Cells of one colour stay together (paper 3.1, step 4).
  /// True for cells around the part that breaks: unless the whole solid breaks, fragments in them
  /// stay with the rest.
  bool outer = false;
};

/// Cells that tile the box [-kHalfExtent, kHalfExtent]³ without overlap. Adjacent cells share one
/// stored plane, so that both sides of a cut are exactly opposite. Space outside the box belongs to
/// the far cell, which is bounded by the planes of the box: planes 0 to 5.
struct Pattern {
  static constexpr double kHalfExtent = 16;
  static constexpr std::uint32_t kBoxPlanes = 6;

  std::vector<Plane> planes;
  std::vector<Cell> cells;
  Bvh tree;  ///< Tree of the boxes of the cells.
};

/// Returns the id of one side of a plane within the pattern.
constexpr PlaneId pattern_plane(std::uint32_t index, bool flipped) {
  return {2 * std::uint64_t{index} + (flipped ? 1 : 0)};
}
/// Return the index and the side of the plane that an id within the pattern denotes.
constexpr std::uint32_t plane_index(PlaneId pattern_id) {
  return static_cast<std::uint32_t>(pattern_id.value >> 1);
}
constexpr bool plane_flipped(PlaneId pattern_id) { return (pattern_id.value & 1) != 0; }

/// Scale for which a pattern is made.
struct PatternScale {
  double unit_m = 1;   ///< Unit of P: the radius of the impact sphere.
  bool whole = false;  ///< The whole solid breaks: no outer cells are needed.
};

/// Returns the pattern of a material; every seed gives another variant. Throws InputError if the
/// material has no pattern, or if its file is not a valid pattern.
Pattern make_pattern(const PatternSpec& spec, const PatternScale& scale, std::uint64_t seed);

/// Returns the Voronoi cells of `count` sites in the unit ball, denser towards the origin by
/// `falloff` (1: uniform), and, unless `whole`, of a shell of outer sites around the ball.
Pattern voronoi_pattern(int count, double falloff, bool whole, std::uint64_t seed);
/// Returns the Voronoi cells of given sites in the box.
Pattern voronoi_pattern(const std::vector<Vec3>& sites);
/// Returns a spider web in the xz-plane, unbounded along y: `spokes` rays from the origin and
/// `rings` rings of chords in the unit circle.
Pattern web_pattern(int rings, int spokes, double jitter, std::uint64_t seed);
/// Returns `count`³ cubes that fill [-1, 1]³.
Pattern grid_pattern(int count);
/// Returns bricks of size `size` (in units of P) in running bond, with courses along x and the
/// impact in the middle of a brick: as many as cover the unit ball, but at most kMostBricks.
Pattern brick_pattern(const Vec3& size);
inline constexpr int kMostBricks = 7000;
/// Returns `count` splinters along x that fill [-1, 1]³, split mostly by planes across y.
Pattern slab_pattern(int count, double jitter, std::uint64_t seed);
/// Returns the cells of a plug and of the rings around it (see Plug); `unit_m` is the unit of P.
Pattern plug_pattern(const Plug& plug, double unit_m, std::uint64_t seed);
/// Returns cells read from an .obj file. Each group (`g` or `o`) is one convex cell; the cells fill
/// their bounding box around the origin, and groups with one material (`usemtl`) share a colour.
/// `name` is for messages. Throws InputError if the file is anything else.
Pattern read_pattern(std::istream& obj, const std::string& name);

/// Gives the inner cells `count` colours, that of the nearest of random cells: pieces are concave.
void join_colors(Pattern& pattern, int count, std::uint64_t seed);

/// Returns the plane parallel to y through two points (x, z); its normal is to the right of the
/// direction from a to b.
Plane plane_parallel_to_y(const Vec2& a, const Vec2& b);
/// Returns the planes of the box, with which every pattern begins.
std::vector<Plane> box_planes();
/// Returns the box itself; its faces have the ids of planes 0 to 5.
ConvexPolyhedron pattern_box();
/// Returns the part of the box within half-spaces, by ids within the pattern; empty if none.
ConvexPolyhedron cut_cell(const std::vector<Plane>& planes, std::span<const PlaneId> sides);
/// Appends the planes of `inner` (two per axis: high, low) and the outer cells around it; returns
/// the index of the first plane.
std::uint32_t add_outer_cells(Pattern& pattern, const Box& inner);
/// Completes a pattern with planes and polyhedra: sets volumes, one colour per cell, and the tree.
void finish(Pattern& pattern);

}  // namespace sunder::fracture
