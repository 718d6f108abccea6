// The air that carries dust: an incompressible flow on a coarse grid of fixed size, placed around
// the dust and moved by solids, by the dust's weight and by what breaks throw into it.
#pragma once

#include <array>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/lattice.h"
#include "solver/particles/pressure.h"
#include "solver/particles/solids.h"

namespace sunder::solver {

/// The flow near a point.
struct AirGradient {
  Vec3f vorticity_s = Vec3f::Zero();
  Mat3f strain_s = Mat3f::Zero();  ///< Symmetric part of the velocity gradient.
};

/// The part of a field that belongs to an axis.
template <class Fields>
auto& of(Fields& fields, int axis) {
  return fields[static_cast<std::size_t>(axis)];
}

/// Velocities on cell faces (Harlow and Welch 1965); advected semi-Lagrangian, of second order.
/// Solids move the air as a penalty on the part of a face that they cover; beyond the grid the
/// air is still and its pressure zero.
class Air {
 public:
  /// Counts are multiples of 8.
  explicit Air(const Vec3i& counts);

  /// The smallest cells of which so many hold dust of an extent with room to spare.
  static double cell_m_for(const Vec3& extent, const Vec3i& counts);
  /// Whether so many cells hold dust of an extent along an axis with room to spare.
  static bool fits(double extent_m, int count, double cell_m);
  /// Moves the grid, or makes its cells larger or smaller, so that it holds `dust` with room to
  /// spare; the flow stays where it is. True if it moved.
  bool place(const Box& dust, double ground_m);
  /// Goes on with the flow of another, on a grid of its own; both are placed.
  void take_over(const Air& other) { other.carry(grid_, velocity_); }
  const Grid& grid() const { return grid_; }

  /// Forgets the loads of the last step.
  void clear_loads();
  /// What the dust in a cell weighs, in kg.
  void add_dust(std::size_t cell, float mass_kg);
  /// Mass that enters the air with a momentum of its own, where there is dust.
  void add_momentum(std::size_t cell, float mass_kg, const Vec3f& velocity_W);

  void advance(double dt_s, const Vec3& gravity_W, const Obstacles& obstacles);

  /// Whether the grid reaches there; beyond it the air is still.
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
  AirGradient gradient(const Vec3i& cell) const;
  /// Solid part of a cell.
  float solid(const Vec3i& cell) const {
    return solids_.fraction[grid_.lattice.index(cell.x(), cell.y(), cell.z())];
  }

  int iterations() const { return iterations_; }
  /// Largest |div u| · cell / largest |u| as it is now.
  float divergence() const;

 private:
  void carry(const Grid& grid, std::array<Field, 3>& into) const;
  void advect(float dt_s);
  void load(float dt_s, const Vec3f& gravity_W);
  void couple();
  void project();
  void slip_on_ground();
  float sample(int axis, const Vec3f& at) const;
  float between(int axis, const Vec3f& at) const;

  Grid grid_;
  bool placed_ = false;
  std::array<Field, 3> velocity_;  ///< Lower faces of cells.
  std::array<Field, 3> advected_;
  Solids solids_;
  std::vector<std::size_t> loaded_;  ///< Cells with dust.
  Field dust_kg_;
  Field thrown_kg_;
  std::array<Field, 3> thrown_Ns_;
  PressureSolver solver_;
  std::vector<float> fastest_;  ///< Of a layer's flow, before it is projected.
  int iterations_ = 0;
};

}  // namespace sunder::solver
