// Exponential and logarithm from series: the C library's differ between processors, and simulated
// state may not.
#pragma once

namespace sunder {

/// Natural logarithm of a positive, normal number, within 1e-15 of it or of 1. The same bits on
/// every machine.
double natural_logarithm(double x);

/// e to the power of `x`, |x| <= 700, within 1e-15·(1 + |x|) of its value. The same bits on every
/// machine.
double exponential(double x);

}  // namespace sunder
