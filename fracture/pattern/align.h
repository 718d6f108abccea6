// Step 1 of a fracture: the pattern is moved onto the impact (paper 3.1).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "fracture/pattern/pattern.h"

namespace sunder::fracture {

/// Where a pattern lies in the rest frame R: point_R = linear * point_P + origin_R.
struct Placement {
  Mat3 linear = Mat3::Identity();  ///< Any map of positive determinant.
  Vec3 origin_R = Vec3::Zero();    ///< The impact.

  Vec3 operator*(const Vec3& point_P) const { return linear * point_P + origin_R; }
};

/// A pattern at its place, as far as it reaches into some box.
struct AlignedPattern {
  struct Cell {
    std::uint32_t index = 0;  ///< In pattern->cells.
    Box box;
    double volume = 0;  ///< Of the aligned cell: the pattern's, times the determinant.
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
  };

  const Pattern* pattern = nullptr;
  std::uint64_t event = 0;
  Placement placement;
  Mat3 P_of_R = Mat3::Identity();  ///< Inverse of placement.linear.
  std::vector<Plane> planes;       ///< Of the pattern, in R; unit normals.
  std::vector<Cell> cells;         ///< Those that reach into the box, ascending by index.
  std::vector<Vec3> vertices;      ///< Of the cells.

  /// The plane of a cell's face, and its name for all time.
  Plane plane(PlaneId pattern_id) const;
  PlaneId name(PlaneId pattern_id) const;
  /// The corners of a cell, in R.
  std::span<const Vec3> cell_vertices(const Cell& cell) const {
    return std::span(vertices).subspan(cell.first_vertex, cell.vertex_count);
  }
  /// Indices into `cells` of those whose box overlaps `box_R`, ascending.
  void overlapping(const Box& box_R, std::vector<std::uint32_t>& found) const;
  /// The cell as a solid in R, named after the event.
  ConvexPolyhedron polyhedron(const Cell& cell) const;
};

/// Moves `pattern` to its place; only cells that may reach into `interest_R` are kept. The names
/// of planes follow from `event` and the pattern alone.
AlignedPattern align(const Pattern& pattern, const Placement& placement, std::uint64_t event,
                     const Box& interest_R);

}  // namespace sunder::fracture
