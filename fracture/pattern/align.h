// Step 1 of a fracture: a pattern is moved to the impact (paper 3.1).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "fracture/pattern/pattern.h"

namespace sunder::fracture {

/// Affine map from the pattern's frame P to rest frame R: point_R = linear * point_P + origin_R.
struct Placement {
  Mat3 linear = Mat3::Identity();  ///< Its determinant is positive.
  Vec3 origin_R = Vec3::Zero();    ///< Point of impact.

  Vec3 operator*(const Vec3& point_P) const { return linear * point_P + origin_R; }
};

/// A pattern in the rest frame, restricted to the cells that may reach into a given box.
struct AlignedPattern {
  struct Cell {
    std::uint32_t index = 0;  ///< Index in pattern->cells.
    Box box;
    /// Volume of the aligned cell: that of the pattern's cell times the determinant of the map.
    double volume = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
  };

  const Pattern* pattern = nullptr;
  std::uint64_t event = 0;
  Placement placement;
  Mat3 P_of_R = Mat3::Identity();  ///< Inverse of placement.linear.
  std::vector<Plane> planes;       ///< Planes of the pattern in R, with unit normals.
  std::vector<Cell> cells;         ///< Ascending by index.
  std::vector<Vec3> vertices;      ///< Vertices of `cells`, in R.

  /// Return the plane of a cell's face in R, and its permanent id, which is unique in a run.
  Plane plane(PlaneId pattern_id) const;
  PlaneId name(PlaneId pattern_id) const;
  /// Returns the vertices of a cell, in R.
  std::span<const Vec3> cell_vertices(const Cell& cell) const {
    return std::span(vertices).subspan(cell.first_vertex, cell.vertex_count);
  }
  /// Sets `found` to the indices into `cells` of those whose box overlaps `box_R`, ascending.
  void overlapping(const Box& box_R, std::vector<std::uint32_t>& found) const;
  /// Returns the cell as a polyhedron in R, with permanent plane ids.
  ConvexPolyhedron polyhedron(const Cell& cell) const;
};

/// Moves `pattern` to the rest frame; keeps only cells that may reach into `interest_R`. The
/// permanent ids of planes depend only on `event` and the pattern.
AlignedPattern align(const Pattern& pattern, const Placement& placement, std::uint64_t event,
                     const Box& interest_R);

}  // namespace sunder::fracture
