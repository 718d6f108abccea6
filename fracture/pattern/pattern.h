// Fracture patterns: space cut into convex cells around an impact at the origin (paper 3.1).
//
// Read first: Pattern. A pattern is made once in its own frame P, whose unit is the radius of the
// impact sphere, and then aligned with any number of impacts (align.h). Each kind has a file:
// voronoi_pattern, web_pattern, block_patterns (grid and bricks), slab_pattern (wood) and
// file_pattern; pattern.cpp has what they are built with.
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

/// One convex cell. Face f lies in plane `plane_of(f)` of its pattern.
struct Cell {
  /// Its face ids name the pattern's planes: 2·index + side, side 1 being the flipped plane.
  ConvexPolyhedron polyhedron;
  double volume = 0;
  std::uint32_t color = 0;  ///< Cells of one colour stay together (paper 3.1, step 4).
  /// Surroundings: unless the whole solid breaks, what lies in here stays with the rest.
  bool outer = false;
};

/// Cells that tile the box [-kHalfExtent, kHalfExtent]³ without overlap. Cells that meet share one
/// stored plane, so that a cut has exactly opposite sides. What lies outside the box belongs to
/// the far cell, which is cut off by the box's planes: planes 0 to 5.
struct Pattern {
  static constexpr double kHalfExtent = 16;
  static constexpr std::uint32_t kBoxPlanes = 6;

  std::vector<Plane> planes;
  std::vector<Cell> cells;
  Bvh tree;  ///< Over the cells' boxes.
};

/// The name of one side of a pattern's plane, within the pattern.
constexpr PlaneId pattern_plane(std::uint32_t index, bool flipped) {
  return {2 * std::uint64_t{index} + (flipped ? 1 : 0)};
}
/// Which plane a name is of, and of which side.
constexpr std::uint32_t plane_index(PlaneId pattern_id) {
  return static_cast<std::uint32_t>(pattern_id.value >> 1);
}
constexpr bool plane_flipped(PlaneId pattern_id) { return (pattern_id.value & 1) != 0; }

/// How a pattern is made to measure.
struct PatternScale {
  double unit_m = 1;   ///< The unit of P: the radius of the impact sphere.
  bool whole = false;  ///< The whole solid breaks: no surroundings are needed.
};

/// The pattern of a material; every seed gives another variant. Throws InputError if it has none,
/// or its file is not one.
Pattern make_pattern(const PatternSpec& spec, const PatternScale& scale, std::uint64_t seed);

/// Voronoi cells of `count` sites within the unit ball, packed towards the origin by `falloff`
/// (1: uniform), and, unless `whole`, of a shell of outer sites around it.
Pattern voronoi_pattern(int count, double falloff, bool whole, std::uint64_t seed);
/// The Voronoi cells of any sites within the box.
Pattern voronoi_pattern(const std::vector<Vec3>& sites);
/// A spider web in the xz-plane, without end along y: `spokes` rays from the origin, `rings` of
/// chords within the unit circle.
Pattern web_pattern(int rings, int spokes, double jitter, std::uint64_t seed);
/// `count`³ cubes that fill [-1, 1]³.
Pattern grid_pattern(int count);
/// Bricks of a size (in units of P) in running bond, courses along x, the impact in the middle of
/// one; as many as cover the unit ball, but no more than kMostBricks.
Pattern brick_pattern(const Vec3& size);
inline constexpr int kMostBricks = 7000;
/// `count` splinters along x that fill [-1, 1]³: split by planes mostly across y.
Pattern slab_pattern(int count, double jitter, std::uint64_t seed);
/// Cells of a plug and the rings around it (see Plug), in units of `unit_m`.
Pattern plug_pattern(const Plug& plug, double unit_m, std::uint64_t seed);
/// Cells from an .obj: one convex cell a group (`g` or `o`), which fill their bounding box around
/// the origin; groups of one material (`usemtl`) share a colour. `name` is for messages. Throws
/// InputError if it is anything else.
Pattern read_pattern(std::istream& obj, const std::string& name);

/// Joins the inner cells around `count` of them, so that pieces are not convex.
void join_colors(Pattern& pattern, int count, std::uint64_t seed);

/// The plane parallel to y through two points (x, z), its normal to the right of the way from a to
/// b.
Plane upright_plane(const Vec2& a, const Vec2& b);
/// Starts a pattern: the planes of the box.
std::vector<Plane> box_planes();
/// The box itself, with its faces named after planes 0 to 5.
ConvexPolyhedron pattern_box();
/// The part of the box within half-spaces: ids name the pattern's planes; empty if there is none.
ConvexPolyhedron cut_cell(const std::vector<Plane>& planes, std::span<const PlaneId> sides);
/// Adds the planes of `inner` (two an axis: high, low) and the outer cells around it; the index of
/// the first plane.
std::uint32_t surround(Pattern& pattern, const Box& inner);
/// Finishes a pattern whose planes and polyhedra are there: volumes, one colour a cell, tree.
void finish(Pattern& pattern);

}  // namespace sunder::fracture
