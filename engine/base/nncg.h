// Nonsmooth nonlinear conjugate gradients (NNCG: Silcowitz-Hansen, Niebe and Erleben 2010), which
// accelerate projected Gauss-Seidel: the solution needs far fewer sweeps.
//
// The change of x by a sweep takes the place of the negative gradient. After each sweep the caller
// applies
//     step = beta · direction,  x += step,  direction = step + change
// to its own arrays. This file computes beta, which the contact and pressure solvers share.
#pragma once

namespace sunder {

/// Computes the beta of each sweep of one solve.
class Nncg {
 public:
  /// Returns the beta of Fletcher and Reeves: the squared norm of the last sweep's change over that
  /// of the sweep before, in any norm that the solver uses throughout. Returns 0, which restarts
  /// the method, after the first sweep and whenever the change has grown.
  double beta(double squared_change) {
    const double beta = previous_squared_change_ > 0 && squared_change <= previous_squared_change_
                            ? squared_change / previous_squared_change_
                            : 0;
    previous_squared_change_ = squared_change;
    return beta;
  }

 private:
  double previous_squared_change_ = 0;
};

}  // namespace sunder
