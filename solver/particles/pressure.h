// The pressure that makes a flow on a lattice free of divergence: conjugate gradients,
// preconditioned by one multigrid V-cycle (as McAdams et al. 2010 do).
#pragma once

#include <array>
#include <vector>

#include "solver/particles/lattice.h"

namespace sunder::solver {

/// Solves Σ_f a_f (p_cell − p_neighbour) = −divergence, p = 0 beyond the rim.
class PressureSolver {
 public:
  /// Counts are at least 4; along x a multiple of 8, 128 at most. The more often they halve, the
  /// faster.
  explicit PressureSolver(const Vec3i& counts);

  /// Per axis, the coefficient of each face: its open part; twice that on the rim, where p = 0
  /// lies on the face; 0 where the rim is closed. Set, then call solve().
  std::array<Field, 3>& coefficients() { return levels_[0].a; }
  /// Minus the net outflow of each cell.
  Field& inflow() { return levels_[0].rest; }
  /// As the last solve left it; the next one starts from here.
  Field& pressure() { return pressure_; }
  /// Until no cell's net outflow exceeds the tolerance, in a bounded number of iterations, which
  /// it returns.
  int solve(float tolerance);

 private:
  /// One grid of the hierarchy. On the finest, `rest` is the residual of the whole solve.
  struct Level {
    Lattice lattice;
    std::array<Field, 3> a;
    Field inverse_diagonal;
    Field rest;        ///< The right-hand side.
    Field correction;  ///< The solution.
  };
  static constexpr int kLongestRow = 128;
  enum class Order { kForward, kBackward };

  static void find_diagonal(Level& level);
  static void coarsen(const Level& fine, Level& coarse);
  static void begin(Level& level);
  static void smooth(Level& level, Order order);
  static void smooth_colour(Level& level, int colour);
  static void restrict_rest(const Level& fine, Level& coarse);
  static void prolong(const Level& coarse, Level& fine);
  void cycle(std::size_t level);
  double apply_and_dot();
  double dot(const Field& x, const Field& y);
  float descend(double slope);
  void update_direction(float beta);
  float step(float alpha);

  std::vector<Level> levels_;
  Field pressure_, direction_, image_;
  std::vector<double> partial_;  ///< Per layer of cells.
};

}  // namespace sunder::solver
