// Placement of the grid of the air in the world.
#pragma once

#include "engine/base/types.h"
#include "solver/particles/lattice.h"

namespace sunder::solver {

/// A lattice in the world: the lower corner of cell (1, 1, 1) is at the origin.
struct Grid {
  Lattice lattice;
  Vec3 origin_W = Vec3::Zero();
  double cell_m = 1;
  bool on_ground = false;  ///< True if the floor of the grid is the ground, which is closed.

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const {
    if (!(origin_W.cwiseAbs().maxCoeff() < 1e12)) return "origin_W";
    return cell_m > 1e-9 && cell_m < 1e12 ? nullptr : "cell_m";
  }
  Vec3 extent_m() const { return cell_m * lattice.counts.cast<double>(); }
};

/// Returns the smallest cell size at which `counts` cells hold dust of this extent with a margin.
double cell_m_for(const Vec3& extent, const Vec3i& counts);
/// Returns true if `count` cells hold dust of this extent along an axis with a margin.
bool grid_fits(double extent_m, int count, double cell_m);
/// Returns true if the grid holds `dust` with a sufficient margin and its cells are not too large.
bool may_stay(const Grid& grid, const Box& dust);
/// Returns a grid around `dust` with the cell counts of `grid`. If `placed`, the grid moves by
/// whole cells from its old place, and its cell size changes only if necessary.
Grid grid_around(const Box& dust, double ground_m, const Grid& grid, bool placed);

}  // namespace sunder::solver
