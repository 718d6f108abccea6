// Where the grid of the air is.
#pragma once

#include "engine/base/types.h"
#include "solver/particles/lattice.h"

namespace sunder::solver {

/// A lattice in the world: cell (1, 1, 1) begins at the origin.
struct Grid {
  Lattice lattice;
  Vec3 origin_W = Vec3::Zero();
  double cell_m = 1;
  bool on_ground = false;  ///< Its floor is the ground, which is closed.

  Vec3 extent_m() const { return cell_m * lattice.counts.cast<double>(); }
};

/// The smallest cells of which so many hold dust of an extent with room to spare.
double cell_m_for(const Vec3& extent, const Vec3i& counts);
/// Whether so many cells hold dust of an extent along an axis with room to spare.
bool grid_fits(double extent_m, int count, double cell_m);
/// Whether a grid holds `dust` so well that it may stay.
bool may_stay(const Grid& grid, const Box& dust);
/// A grid of as many cells around `dust`; not `placed` yet, it goes anywhere, else it moves from
/// where it is by whole cells, and no smaller or larger than it must be.
Grid grid_around(const Box& dust, double ground_m, const Grid& grid, bool placed);

}  // namespace sunder::solver
