// Solves K x = f for the springs of a compound: conjugate gradients, preconditioned by a W-cycle
// over coarser and coarser levels of springs.
//
// Read first: Multigrid::solve(), then cycle().
#pragma once

#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include "fracture/spring_level.h"

namespace sunder::fracture {

struct SolveResult {
  int iterations = 0;
  double residual = 0;  ///< Of forces and torques, relative to f.
  double error = 0;     ///< Estimate in the norm of energy, relative to x: that of the stresses.
  bool converged = false;
};

class Multigrid {
 public:
  /// Every node hangs on the world, by springs over other nodes perhaps.
  Multigrid(std::size_t nodes, std::vector<Spring> springs);

  const SpringLevel& finest() const { return levels_.front(); }
  /// Improves x until residual and error are at most `tolerance`, or for so many iterations.
  SolveResult solve(const Nodal& f, double tolerance, int most_iterations, Nodal& x) const;

 private:
  /// Memory of one level of a cycle.
  struct Scratch {
    Nodal rest, coarse_r, coarse_z, correction;
  };

  void factorize();
  /// z = (about) K⁻¹ r, on one level and those below it; symmetric.
  void cycle(std::size_t level, const Nodal& r, Nodal& z, std::span<Scratch> scratch) const;
  void solve_coarsest(const Nodal& r, Nodal& z) const;

  std::vector<SpringLevel> levels_;  ///< Finest first.
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
};

}  // namespace sunder::fracture
