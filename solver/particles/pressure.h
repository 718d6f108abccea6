// Solver for the pressure that makes a flow on a lattice divergence-free: conjugate gradients
// preconditioned by one multigrid V-cycle (McAdams et al. 2010).
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "solver/particles/lattice.h"

namespace sunder::solver {

/// Solves Σ_f a_f (p_cell − p_neighbour) = −divergence over the faces f of each cell, with p = 0 on
/// the faces of the boundary. p is the pressure times dt / (density · cell size).
class PressureSolver {
 public:
  /// Makes a solver for `counts` cells per axis: at least 4; along x a multiple of 8, at most 128.
  /// The more often the counts can be halved, the faster the solve.
  explicit PressureSolver(const Vec3i& counts);

  /// Returns the coefficients of the faces of each axis, to be set before solve(): the open
  /// fraction; twice that on the boundary, which is half a cell away; 0 where it is closed.
  std::array<Field, 3>& coefficients() { return levels_[0].a; }
  /// Returns the right-hand side, to be set before solve(), which overwrites it: the net inflow of
  /// each cell.
  Field& inflow() { return levels_[0].residual; }
  /// Returns the pressure of the last solve, from which the next one starts.
  Field& pressure() { return pressure_; }
  /// Solves until the net outflow of each cell is within the tolerance; returns the number of
  /// iterations, up to 16.
  int solve(float tolerance);

  static auto fields(auto& self) {
    return std::tie(self.levels_, self.pressure_, self.direction_, self.matrix_direction_,
                    self.partial_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  const Lattice& lattice() const { return levels_[0].lattice; }

 private:
  /// One grid of the hierarchy. On the finest, `residual` is that of the whole solve.
  struct Level {
    Lattice lattice;
    std::array<Field, 3> a;
    Field inverse_diagonal;
    Field residual;    ///< Right-hand side: the residual of the next finer grid.
    Field correction;  ///< Approximate solution.
  };
  static constexpr int kLongestRow = 128;
  enum class Order { kForward, kBackward };

  static void find_diagonal(Level& level);
  static void coarsen(const Level& fine, Level& coarse);
  static void smooth_from_zero(Level& level);
  static void smooth(Level& level, Order order);
  /// Red-black Gauss-Seidel between rows, Jacobi along a row.
  static void smooth_rows(Level& level, int color);
  static void restrict_residual(const Level& fine, Level& coarse);
  static void prolong(const Level& coarse, Level& fine);
  void cycle(std::size_t level);
  double apply_and_dot();
  double dot(const Field& x, const Field& y);
  /// Moves the pressure along the search direction by the exact step; returns the largest residual.
  float minimize_along_direction(double direction_dot_residual);
  void update_direction(float beta);
  float step(float alpha);

  std::vector<Level> levels_;
  Field pressure_, direction_, matrix_direction_;
  std::vector<double> partial_;  ///< Partial result of each layer of cells.
};

}  // namespace sunder::solver
