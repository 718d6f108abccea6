// Solves K x = f for the springs of a compound: conjugate gradients (Hestenes and Stiefel 1952),
// preconditioned by a W-cycle over coarser and coarser levels of springs, of which the last is
// solved directly; for most compounds that is the first. The cycle is in single precision: it
// decides how fast the answer comes, not what it is.
//
// Read first: Multigrid::solve(), then cycle().
#pragma once

#include <span>
#include <vector>

#include "fracture/stress/block_cholesky.h"
#include "fracture/stress/spring_groups.h"
#include "fracture/stress/spring_level.h"

namespace sunder::fracture {

/// How far a solve came.
struct SolveResult {
  int iterations = 0;
  double residual = 0;  ///< Of forces and torques, relative to f.
  double error = 0;     ///< Estimate in the norm of energy, relative to x: that of the stresses.
  bool converged = false;
};

/// The springs of a compound on all levels; any thread may solve.
class Multigrid {
 public:
  /// Every node hangs on the world, by springs over other nodes perhaps.
  Multigrid(std::size_t nodes, std::vector<Spring> springs);
  /// Another after an edit of its springs: on all levels, groups that an edit does not reach stay
  /// as they are, and what is new joins the groups beside it.
  Multigrid(const Multigrid& old, SpringEdit edit);

  /// The finest level, in SI units.
  const SpringLevel<double>& springs() const { return springs_; }
  /// What it cost to make the coarsest level ready, in visits of springs: a product of blocks takes
  /// about as long, what else there is to do counted.
  std::uint64_t direct_work() const { return coarsest_.products(); }
  /// Improves x until residual and error are at most `tolerance`, what is left is rounding
  /// (`nothing_N`), or so many iterations are done. `way`: the direction in which an unfinished
  /// solve went last, from which this one goes on; empty if there was none.
  SolveResult solve(const Nodal<double>& f, double tolerance, double nothing_N, int most_iterations,
                    Nodal<double>& x, Nodal<double>& way) const;

 private:
  /// Memory of one level of a cycle.
  struct Scratch {
    Nodal<float> rest, coarse_r, coarse_z, coarse_rest, correction;
  };

  void to_units(std::vector<Spring>& springs) const;
  bool factorize(bool to_be);
  std::vector<Scratch> scratch() const;
  /// z = (about) K⁻¹ r, on one level and those below it; symmetric.
  void cycle(std::size_t level, const Nodal<float>& r, Nodal<float>& z,
             std::span<Scratch> scratch) const;
  void solve_coarsest(const Nodal<float>& r, Nodal<float>& z) const;

  SpringLevel<double> springs_;
  double unit_N_m_;  ///< The levels' unit of stiffness: their numbers are about one.
  std::vector<SpringLevel<float>> levels_;  ///< The same springs, then coarser ones.
  std::vector<SpringGroups> groups_;        ///< Of each level but the coarsest.
  BlockCholesky coarsest_;
};

}  // namespace sunder::fracture
