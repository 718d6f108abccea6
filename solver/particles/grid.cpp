#include "solver/particles/grid.h"

#include <cmath>

#include "engine/base/check.h"

namespace sunder::solver {
namespace {

constexpr double kSmallestCell_m = 0.125;
constexpr double kNotch = 1.4142135623730951;  // cells grow and shrink by this factor
constexpr double kRoom = 0.15;                 // part of the cells around the dust, on each side
constexpr double kGroundCells = 6;             // over the ground, within which it is the floor
constexpr double kLeastMargin = 0.075;         // of which so much must be left before it moves

/// Whether dust of this extent fits when the grid is placed anew.
bool all_fit(const Vec3& extent, const Vec3i& counts, double cell_m) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid_fits(extent[axis], counts[axis], cell_m)) return false;
  }
  return true;
}

double whole(double x, double unit) { return std::floor(x / unit + 0.5) * unit; }

bool too_large(const Grid& grid, const Vec3& extent) {
  const double smaller_m = grid.cell_m / (kNotch * kNotch);
  return smaller_m > 0.99 * kSmallestCell_m && all_fit(extent, grid.lattice.counts, smaller_m);
}

}  // namespace

bool grid_fits(double extent_m, int count, double cell_m) {
  return extent_m <= (1 - 2 * kRoom) * cell_m * count;
}

double cell_m_for(const Vec3& extent, const Vec3i& counts) {
  double cell_m = kSmallestCell_m;
  while (!all_fit(extent, counts, cell_m)) cell_m *= kNotch;
  return cell_m;
}

bool may_stay(const Grid& grid, const Box& dust) {
  const Vec3 margin = kLeastMargin * grid.extent_m();
  const Vec3 over = dust.max + margin - grid.origin_W - grid.extent_m();
  const Vec3 under = dust.min - margin - grid.origin_W;
  const bool inside = (over.array() <= 0).all() && under.x() >= 0 && under.z() >= 0 &&
                      (under.y() >= 0 || grid.on_ground);
  return inside && !too_large(grid, dust.extent());
}

Grid grid_around(const Box& dust, double ground_m, const Grid& old, bool placed) {
  const Vec3 extent = dust.extent();
  SUNDER_CHECK(extent.allFinite());
  Grid grid = old;
  const double cell_m = cell_m_for(extent, grid.lattice.counts);
  // Without need the cells stay as large as they are.
  if (!placed || too_large(old, extent) || cell_m > old.cell_m) grid.cell_m = cell_m;
  const Vec3 corner = dust.center() - 0.5 * grid.extent_m();
  // Moved by whole cells, the flow is copied, not blurred.
  const Vec3 from = placed ? old.origin_W : corner;
  grid.origin_W.x() = from.x() + whole(corner.x() - from.x(), grid.cell_m);
  grid.origin_W.z() = from.z() + whole(corner.z() - from.z(), grid.cell_m);
  const double above_m = dust.min.y() - kRoom * grid.extent_m().y() - ground_m;
  const double top_m = ground_m + (1 - kRoom) * grid.extent_m().y();
  grid.on_ground = above_m <= 0 ||
                   (dust.max.y() <= top_m && dust.min.y() <= ground_m + kGroundCells * grid.cell_m);
  grid.origin_W.y() = ground_m + (grid.on_ground ? 0 : whole(above_m, grid.cell_m));
  return grid;
}

}  // namespace sunder::solver
