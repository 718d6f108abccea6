// Where the grid of the air is, and the flow between its faces.
#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "solver/particles/air.h"

namespace sunder::solver {
namespace {

constexpr double kSmallestCell_m = 0.125;
constexpr double kNotch = 1.4142135623730951;  // cells grow and shrink by this factor
constexpr double kRoom = 0.15;                 // part of the cells around the dust, on each side
constexpr double kGroundCells = 6;             // over the ground, within which it is the floor
constexpr double kMargin = 0.075;              // of which so much must be left before it moves

/// Whether dust of this extent fits when the grid is placed anew.
bool all_fit(const Vec3& extent, const Vec3i& counts, double cell_m) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!Air::fits(extent[axis], counts[axis], cell_m)) return false;
  }
  return true;
}

double whole(double x, double unit) { return std::floor(x / unit + 0.5) * unit; }

}  // namespace

bool Air::fits(double extent_m, int count, double cell_m) {
  return extent_m <= (1 - 2 * kRoom) * cell_m * count;
}

double Air::cell_m_for(const Vec3& extent, const Vec3i& counts) {
  double cell_m = kSmallestCell_m;
  while (!all_fit(extent, counts, cell_m)) cell_m *= kNotch;
  return cell_m;
}

bool Air::place(const Box& dust, double ground_m) {
  const Vec3i& counts = grid_.lattice.counts;
  const Vec3 extent = dust.extent();
  SUNDER_CHECK(extent.allFinite());
  const Vec3 margin = kMargin * grid_.extent_m();
  const Vec3 over = dust.max + margin - grid_.origin_W - grid_.extent_m();
  const Vec3 under = dust.min - margin - grid_.origin_W;
  const bool inside = (over.array() <= 0).all() && under.x() >= 0 && under.z() >= 0 &&
                      (under.y() >= 0 || grid_.on_ground);
  const double smaller_m = grid_.cell_m / (kNotch * kNotch);
  const bool too_large = smaller_m > 0.99 * kSmallestCell_m && all_fit(extent, counts, smaller_m);
  if (placed_ && inside && !too_large) return false;
  Grid grid = grid_;
  const double cell_m = cell_m_for(extent, counts);
  // Without need the cells stay as large as they are.
  if (!placed_ || too_large || cell_m > grid_.cell_m) grid.cell_m = cell_m;
  const Vec3 corner = dust.center() - 0.5 * grid.extent_m();
  // Moved by whole cells, the flow is copied, not blurred.
  const Vec3 from = placed_ ? grid_.origin_W : corner;
  grid.origin_W.x() = from.x() + whole(corner.x() - from.x(), grid.cell_m);
  grid.origin_W.z() = from.z() + whole(corner.z() - from.z(), grid.cell_m);
  const double above_m = dust.min.y() - kRoom * grid.extent_m().y() - ground_m;
  const double top_m = ground_m + (1 - kRoom) * grid.extent_m().y();
  grid.on_ground = above_m <= 0 ||
                   (dust.max.y() <= top_m && dust.min.y() <= ground_m + kGroundCells * grid.cell_m);
  grid.origin_W.y() = ground_m + (grid.on_ground ? 0 : whole(above_m, grid.cell_m));
  if (placed_) {
    carry(grid, advected_);
    std::swap(velocity_, advected_);
    std::fill(solver_.pressure().begin(), solver_.pressure().end(), 0.0f);
  }
  grid_ = grid;
  placed_ = true;
  return true;
}

/// The flow on another grid; beyond this one the air is still.
void Air::carry(const Grid& grid, std::array<Field, 3>& into) const {
  const Vec3i last = grid.lattice.counts + Vec3i::Ones();
  const auto scale = static_cast<float>(grid.cell_m / grid_.cell_m);
  const Vec3f shift = ((grid.origin_W - grid_.origin_W) / grid_.cell_m).cast<float>();
  const Vec3f inside = grid_.lattice.counts.cast<float>() + Vec3f::Constant(1.5f);
  for (int axis = 0; axis < 3; ++axis) {
    Field& field = of(into, axis);
    std::fill(field.begin(), field.end(), 0.0f);
    // In cells from the corner to the index of a value: faces lie on the corner along their axis.
    Vec3f half = Vec3f::Constant(0.5f);
    half[axis] = 1;
    for_chunks(
        static_cast<std::size_t>(last.z()), 4,
        [&](std::size_t begin, std::size_t end, std::size_t) {
          for (int k = static_cast<int>(begin) + 1; k <= static_cast<int>(end); ++k) {
            for (int j = 1; j <= last.y(); ++j) {
              for (int i = 1; i <= last.x(); ++i) {
                if ((Vec3i(i, j, k) - Vec3i::Unit(axis) - grid.lattice.counts).maxCoeff() > 0)
                  continue;
                const Vec3f at = scale * (Vec3i(i, j, k).cast<float>() - half) + shift + half;
                if ((at.array() < 0.5f).any() || (at.array() > inside.array()).any()) continue;
                field[grid.lattice.index(i, j, k)] = sample(axis, at);
              }
            }
          }
        });
  }
}

Vec3f Air::velocity(const Vec3f& point_W) const {
  if (!contains(point_W)) return Vec3f::Zero();
  const Vec3f cells = to_cells(point_W);
  Vec3f velocity;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f at = cells + Vec3f::Constant(0.5f);
    at[axis] = cells[axis] + 1;
    velocity[axis] = between(axis, at);
  }
  return velocity;
}

/// At indices of the axis' faces, kept within them.
float Air::sample(int axis, const Vec3f& at) const {
  const Vec3f most = (grid_.lattice.counts + Vec3i::Ones()).cast<float>();
  return between(axis, at.cwiseMax(0.0f).cwiseMin(most));
}

/// Trilinear, between faces that are there.
float Air::between(int axis, const Vec3f& at) const {
  const Lattice& lattice = grid_.lattice;
  const Vec3i low = at.cast<int>();
  const Vec3f part = at - low.cast<float>();
  const float* u = &of(velocity_, axis)[lattice.index(low.x(), low.y(), low.z())];
  const std::ptrdiff_t sy = lattice.stride(1), sz = lattice.stride(2);
  const auto along = [&](std::ptrdiff_t o) { return u[o] + part.x() * (u[o + 1] - u[o]); };
  const float near = along(0) + part.y() * (along(sy) - along(0));
  const float far = along(sz) + part.y() * (along(sz + sy) - along(sz));
  return near + part.z() * (far - near);
}

AirGradient Air::gradient(const Vec3i& cell) const {
  const Lattice& lattice = grid_.lattice;
  const std::size_t at = lattice.index(cell.x(), cell.y(), cell.z());
  Mat3f slope;  // of component `axis` along `other`
  for (int axis = 0; axis < 3; ++axis) {
    const float* u = &of(velocity_, axis)[at];
    const std::ptrdiff_t next = lattice.stride(axis);
    for (int other = 0; other < 3; ++other) {
      const std::ptrdiff_t to = lattice.stride(other);
      slope(axis, other) =
          other == axis ? u[next] - u[0] : 0.25f * (u[to] + u[to + next] - u[-to] - u[next - to]);
    }
  }
  slope /= static_cast<float>(grid_.cell_m);
  AirGradient gradient;
  gradient.strain_s = 0.5f * (slope + slope.transpose());
  gradient.vorticity_s =
      Vec3f(slope(2, 1) - slope(1, 2), slope(0, 2) - slope(2, 0), slope(1, 0) - slope(0, 1));
  return gradient;
}

}  // namespace sunder::solver
