// Nonsmooth nonlinear conjugate gradients (NNCG: Silcowitz-Hansen, Niebe and Erleben 2010) around
// sweeps of projected Gauss-Seidel, which come to the same solution in far fewer sweeps.
//
// What a sweep changes stands for the gradient. After each sweep the solver goes on along the
// direction so far,
//     step = beta · direction,  x += step,  direction = step + change,
// in the layout of its own x; how far is the same for all, and said here.
#pragma once

namespace sunder {

/// The beta of each sweep of a solve.
class Nncg {
 public:
  /// Of Fletcher and Reeves, from the square of what the last sweep changed, in any norm that the
  /// solver keeps to: what it is over what it was. 0 begins anew: after the first sweep, and where
  /// changes have grown.
  double beta(double square) {
    const double beta = last_ > 0 && square <= last_ ? square / last_ : 0;
    last_ = square;
    return beta;
  }

 private:
  double last_ = 0;
};

}  // namespace sunder
