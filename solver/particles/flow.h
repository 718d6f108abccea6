// A flow on a grid in the world, sampled at any point.
#pragma once

#include <array>

#include "solver/particles/grid.h"

namespace sunder::solver {

/// Gradient of the flow at a point: vorticity and strain rate, in 1/s.
struct FlowGradient {
  Vec3f vorticity_s = Vec3f::Zero();
  Mat3f strain_s = Mat3f::Zero();  ///< Symmetric part of the velocity gradient.
};

/// Returns the component of a vector field along an axis.
template <class Fields>
auto& of(Fields& fields, int axis) {
  return fields[static_cast<std::size_t>(axis)];
}

/// Velocities on cell faces (Harlow and Welch 1965), in m/s; zero outside the grid.
class Flow {
 public:
  explicit Flow(const Vec3i& counts);

  const Grid& grid() const { return grid_; }
  /// Returns true if the point is in the grid, with a tolerance of 0.01 cells at the lower sides.
  bool contains(const Vec3f& point_W) const {
    const Vec3f at = to_cells(point_W);
    return (at.array() >= -0.01f).all() &&
           (at.array() < grid_.lattice.counts.cast<float>().array()).all();
  }
  /// Returns the indices of the cell that holds a point of the grid.
  Vec3i cell_at(const Vec3f& point_W) const {
    const Vec3f at = to_cells(point_W) + Vec3f::Ones();
    return at.cwiseMax(1.0f).cwiseMin(grid_.lattice.counts.cast<float>()).cast<int>();
  }
  /// Returns the position of a point relative to the lower corner of the grid, in cells.
  Vec3f to_cells(const Vec3f& point_W) const {
    return (point_W - grid_.origin_W.cast<float>()) * static_cast<float>(1 / grid_.cell_m);
  }
  /// Returns the velocity at a point; zero outside the grid.
  Vec3f velocity(const Vec3f& point_W) const;
  FlowGradient gradient(const Vec3i& cell) const;
  /// Writes this flow, sampled on another grid, to `into`.
  void resample(const Grid& grid, std::array<Field, 3>& into) const;
  /// Returns the greatest |div u| · cell size / greatest |u| of the current flow.
  float divergence() const;

 protected:
  Grid grid_;
  std::array<Field, 3> velocity_;  ///< Component along each axis, on the lower faces of cells.

 private:
  float sample(int axis, const Vec3f& at) const;
  float between(int axis, const Vec3f& at) const;
};

}  // namespace sunder::solver
