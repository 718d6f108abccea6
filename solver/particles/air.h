// The air that carries dust: an incompressible flow on a coarse grid of a fixed number of cells,
// placed around the dust and driven by solids, by the weight of the dust and by emitted dust.
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/flow.h"
#include "solver/particles/pressure.h"
#include "solver/particles/solids.h"

namespace sunder::solver {

/// An incompressible flow with second-order semi-Lagrangian advection. Solids drive the air by a
/// penalty on the fraction of a face that they cover; the pressure beyond the grid is zero.
class Air : public Flow {
 public:
  /// Makes a grid of `counts` cells per axis, multiples of 8.
  explicit Air(const Vec3i& counts);

  /// Moves the grid or changes its cell size so that it holds `dust` with a margin, and resamples
  /// the flow. Returns true if the grid changed.
  bool place(const Box& dust, double ground_m);
  /// Copies the flow of `other`, resampled to this grid. Both grids must be placed.
  void copy_flow_from(const Air& other) { other.resample(grid_, velocity_); }

  /// Clears the dust mass and the emitted momentum of the last step.
  void clear_loads();
  /// Adds dust of this mass to a cell.
  void add_dust(std::size_t cell, float mass_kg);
  /// Adds the momentum of newly emitted dust to a cell that add_dust() was called for.
  void add_momentum(std::size_t cell, float mass_kg, const Vec3f& velocity_W);

  void advance(double dt_s, const Vec3& gravity_W, const Obstacles& obstacles);

  /// Returns the solid fraction of a cell; above 1 where obstacles overlap.
  float solid(const Vec3i& cell) const {
    return solids_.fraction[grid_.lattice.index(cell.x(), cell.y(), cell.z())];
  }

  int iterations() const { return iterations_; }

  static auto fields(auto& self) {
    return std::tie(self.grid_, self.velocity_, self.placed_, self.advected_, self.solids_,
                    self.dusty_cells_, self.dust_kg_, self.emitted_kg_, self.emitted_Ns_,
                    self.solver_, self.max_speed_of_layer_, self.iterations_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  void advect(float dt_s);
  void apply_dust_loads(float dt_s, const Vec3f& gravity_W);
  void apply_solids();
  void project();
  void apply_free_slip_at_ground();

  bool placed_ = false;
  std::array<Field, 3> advected_;
  Solids solids_;
  std::vector<std::size_t> dusty_cells_;  ///< Indices of the cells with dust.
  Field dust_kg_;
  Field emitted_kg_;
  std::array<Field, 3> emitted_Ns_;
  PressureSolver solver_;
  /// Greatest speed in each layer of cells, before the projection.
  std::vector<float> max_speed_of_layer_;
  int iterations_ = 0;
};

}  // namespace sunder::solver
