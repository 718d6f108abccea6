// Roots and powers. The C library's cbrt(), hypot() and pow() give different bits on different
// processors, which simulated state must not.
#pragma once

#include <cmath>

namespace sunder {

/// Returns the cube root, with a relative error of at most 3e-16. Gives the same
/// bits on every machine.
double cube_root(double x);

/// Returns sqrt(a² + b²), |a| and |b| at most 1e150, with a relative error of at most 3e-16 where
/// the squares do not underflow. Gives the same bits on every machine.
inline double hypotenuse(double a, double b) { return std::sqrt(a * a + b * b); }

/// Returns a positive, normal number to the power of `exponent`, for results from e^-700 to e^700,
/// with a relative error of at most 3e-15·(1 + |ln(result)|). Gives the same bits on every machine.
double positive_power(double base, double exponent);

}  // namespace sunder
