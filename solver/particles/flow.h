// A flow on a grid in the world, and what it is anywhere.
#pragma once

#include <array>

#include "solver/particles/grid.h"

namespace sunder::solver {

/// The flow near a point.
struct FlowGradient {
  Vec3f vorticity_s = Vec3f::Zero();
  Mat3f strain_s = Mat3f::Zero();  ///< Symmetric part of the velocity gradient.
};

/// The part of a field that belongs to an axis.
template <class Fields>
auto& of(Fields& fields, int axis) {
  return fields[static_cast<std::size_t>(axis)];
}

/// Velocities on cell faces (Harlow and Welch 1965); beyond the grid all is still.
class Flow {
 public:
  explicit Flow(const Vec3i& counts);

  const Grid& grid() const { return grid_; }
  /// Whether the grid reaches there.
  bool contains(const Vec3f& point_W) const {
    const Vec3f at = to_cells(point_W);
    return (at.array() >= -0.01f).all() &&
           (at.array() < grid_.lattice.counts.cast<float>().array()).all();
  }
  /// The cell that holds a point of the grid.
  Vec3i cell_at(const Vec3f& point_W) const {
    const Vec3f at = to_cells(point_W) + Vec3f::Ones();
    return at.cwiseMax(1.0f).cwiseMin(grid_.lattice.counts.cast<float>()).cast<int>();
  }
  /// From the grid's corner, in cells.
  Vec3f to_cells(const Vec3f& point_W) const {
    return (point_W - grid_.origin_W.cast<float>()) * static_cast<float>(1 / grid_.cell_m);
  }
  /// Zero where the grid does not reach.
  Vec3f velocity(const Vec3f& point_W) const;
  FlowGradient gradient(const Vec3i& cell) const;
  /// The same flow on another grid.
  void resample(const Grid& grid, std::array<Field, 3>& into) const;
  /// Largest |div u| · cell / largest |u| as it is now.
  float divergence() const;

 protected:
  Grid grid_;
  std::array<Field, 3> velocity_;  ///< Lower faces of cells.

 private:
  float sample(int axis, const Vec3f& at) const;
  float between(int axis, const Vec3f& at) const;
};

}  // namespace sunder::solver
