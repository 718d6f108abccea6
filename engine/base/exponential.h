// Exponential and logarithm by series. The C library's functions give different bits on different
// processors, which simulated state must not.
#pragma once

namespace sunder {

/// Returns the natural logarithm of a positive, normal number, with an error of at most 1e-15,
/// relative or absolute, whichever is larger. Gives the same bits on every machine.
double natural_logarithm(double x);

/// Returns the logarithm to base 2 of a positive, normal number, with an error of at most 2e-15,
/// relative or absolute, whichever is larger; none for powers of two. Gives the same bits on every
/// machine.
double binary_logarithm(double x);

/// Returns e to the power of `x`, |x| <= 700, with a relative error of at most 1e-15·(1 + |x|).
/// Gives the same bits on every machine.
double exponential(double x);

}  // namespace sunder
