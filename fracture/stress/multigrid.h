// Solves K x = f for the springs of a compound by conjugate gradients (Hestenes and Stiefel 1952),
// preconditioned by a multigrid W-cycle over ever coarser levels of springs. The coarsest level is
// solved directly; in most compounds it is the first. The cycle is in single precision, which
// affects the number of iterations, not the result.
//
// Read first: Multigrid::solve(), then cycle().
#pragma once

#include <span>
#include <tuple>
#include <vector>

#include "fracture/stress/block_cholesky.h"
#include "fracture/stress/spring_groups.h"
#include "fracture/stress/spring_level.h"

namespace sunder::fracture {

/// Result of a solve.
struct SolveResult {
  int iterations = 0;
  double residual = 0;  ///< Residual of forces and torques, relative to f.
  /// Estimated error in the energy norm, relative to x; it is about that of the stresses.
  double error = 0;
  bool converged = false;
};

/// The springs of a compound on all levels; may be used from any thread.
class Multigrid {
 public:
  Multigrid() = default;
  /// Every node must be connected to the world, directly or through other nodes.
  Multigrid(std::size_t nodes, std::vector<Spring> springs);
  /// Copies `old` and applies an edit of its springs. On all levels, groups outside the edit stay
  /// the same, and new nodes join neighbouring groups.
  Multigrid(const Multigrid& old, SpringEdit edit);

  /// Returns the finest level, in SI units.
  const SpringLevel<double>& springs() const { return springs_; }
  /// Returns the cost of factorizing the coarsest level, in evaluations of springs; a block product
  /// counts as one, with the overhead around it.
  std::uint64_t direct_work() const { return coarsest_.products(); }
  /// Improves x until residual and error are at most `tolerance`, the residual is rounding (at most
  /// `rounding_N`), or `most_iterations` are done. `last_direction` is the last search direction of
  /// an unfinished solve, from which this one continues; empty if there is none.
  SolveResult solve(const Nodal<double>& f, double tolerance, double rounding_N,
                    int most_iterations, Nodal<double>& x, Nodal<double>& last_direction) const;

  static auto fields(auto& self) {
    return std::tie(self.springs_, self.unit_N_m_, self.levels_, self.groups_, self.coarsest_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  /// Memory of one level of a cycle.
  struct Scratch {
    Nodal<float> rest, coarse_r, coarse_z, coarse_rest, correction;
  };

  void to_units(std::vector<Spring>& springs) const;
  bool factorize(bool keep_level);
  std::vector<Scratch> scratch() const;
  /// Sets z ≈ K⁻¹ r on one level and those below it, by a symmetric operator.
  void cycle(std::size_t level, const Nodal<float>& r, Nodal<float>& z,
             std::span<Scratch> scratch) const;
  void solve_coarsest(const Nodal<float>& r, Nodal<float>& z) const;

  SpringLevel<double> springs_;
  double unit_N_m_ = 1;  ///< Unit of stiffness of the levels, so that their numbers are about one.
  std::vector<SpringLevel<float>> levels_;  ///< The same springs, then coarser ones.
  std::vector<SpringGroups> groups_;        ///< Groups of each level but the coarsest.
  BlockCholesky coarsest_;
};

}  // namespace sunder::fracture
