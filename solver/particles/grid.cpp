#include "solver/particles/grid.h"

#include <cmath>

#include "engine/base/check.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

/// Returns true if dust of this extent fits with the margin along all axes.
bool fits_along_all_axes(const Vec3& extent, const Vec3i& counts, double cell_m) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid_fits(extent[axis], counts[axis], cell_m)) return false;
  }
  return true;
}

double rounded_to_multiple(double x, double unit) { return std::floor(x / unit + 0.5) * unit; }

bool has_too_large_cells(const Grid& grid, const Vec3& extent) {
  const double smaller_m = grid.cell_m / (kAirCellStep * kAirCellStep);
  return smaller_m > 0.99 * kMinAirCell_m &&
         fits_along_all_axes(extent, grid.lattice.counts, smaller_m);
}

}  // namespace

bool grid_fits(double extent_m, int count, double cell_m) {
  return extent_m <= (1 - 2 * kAirPlacingMargin) * cell_m * count;
}

double cell_m_for(const Vec3& extent, const Vec3i& counts) {
  double cell_m = kMinAirCell_m;
  while (!fits_along_all_axes(extent, counts, cell_m)) cell_m *= kAirCellStep;
  return cell_m;
}

bool may_stay(const Grid& grid, const Box& dust) {
  const Vec3 margin = kAirKeepingMargin * grid.extent_m();
  const Vec3 over = dust.max + margin - grid.origin_W - grid.extent_m();
  const Vec3 under = dust.min - margin - grid.origin_W;
  const bool inside = (over.array() <= 0).all() && under.x() >= 0 && under.z() >= 0 &&
                      (under.y() >= 0 || grid.on_ground);
  return inside && !has_too_large_cells(grid, dust.extent());
}

Grid grid_around(const Box& dust, double ground_m, const Grid& old, bool placed) {
  const Vec3 extent = dust.extent();
  SUNDER_CHECK(extent.allFinite());
  Grid grid = old;
  const double cell_m = cell_m_for(extent, grid.lattice.counts);
  // The cell size changes only if necessary.
  if (!placed || has_too_large_cells(old, extent) || cell_m > old.cell_m) grid.cell_m = cell_m;
  const Vec3 corner = dust.center() - 0.5 * grid.extent_m();
  // A move by whole cells copies the flow without blurring it.
  const Vec3 from = placed ? old.origin_W : corner;
  grid.origin_W.x() = from.x() + rounded_to_multiple(corner.x() - from.x(), grid.cell_m);
  grid.origin_W.z() = from.z() + rounded_to_multiple(corner.z() - from.z(), grid.cell_m);
  const double above_m = dust.min.y() - kAirPlacingMargin * grid.extent_m().y() - ground_m;
  const double top_m = ground_m + (1 - kAirPlacingMargin) * grid.extent_m().y();
  grid.on_ground = above_m <= 0 || (dust.max.y() <= top_m &&
                                    dust.min.y() <= ground_m + kAirGroundCells * grid.cell_m);
  grid.origin_W.y() = ground_m + (grid.on_ground ? 0 : rounded_to_multiple(above_m, grid.cell_m));
  return grid;
}

}  // namespace sunder::solver
