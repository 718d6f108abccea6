// The air that carries dust: an incompressible flow on a coarse grid of fixed size, placed around
// the dust and moved by solids, by the dust's weight and by what breaks throw into it.
#pragma once

#include <array>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/flow.h"
#include "solver/particles/pressure.h"
#include "solver/particles/solids.h"

namespace sunder::solver {

/// A flow advected semi-Lagrangian, of second order. Solids move the air as a penalty on the part
/// of a face that they cover; beyond the grid its pressure is zero.
class Air : public Flow {
 public:
  /// Counts are multiples of 8.
  explicit Air(const Vec3i& counts);

  /// Moves the grid, or makes its cells larger or smaller, so that it holds `dust` with room to
  /// spare; the flow stays where it is. True if it moved.
  bool place(const Box& dust, double ground_m);
  /// Goes on with the flow of another, on a grid of its own; both are placed.
  void take_over(const Air& other) { other.resample(grid_, velocity_); }

  /// Forgets the loads of the last step.
  void clear_loads();
  /// What the dust in a cell weighs, in kg.
  void add_dust(std::size_t cell, float mass_kg);
  /// Mass that enters the air with a momentum of its own, where there is dust.
  void add_momentum(std::size_t cell, float mass_kg, const Vec3f& velocity_W);

  void advance(double dt_s, const Vec3& gravity_W, const Obstacles& obstacles);

  /// Solid part of a cell.
  float solid(const Vec3i& cell) const {
    return solids_.fraction[grid_.lattice.index(cell.x(), cell.y(), cell.z())];
  }

  int iterations() const { return iterations_; }

 private:
  void advect(float dt_s);
  void load(float dt_s, const Vec3f& gravity_W);
  void couple();
  void project();
  void slip_on_ground();

  bool placed_ = false;
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
