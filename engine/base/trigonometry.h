// sin and cos from polynomials: the C library's differ between processors, and simulated state
// may not.
#pragma once

namespace sunder {

struct SinCos {
  double sin;
  double cos;
};

/// Sine and cosine of an angle with |angle| <= 1e6 rad, within 4e-16 absolutely after reduction;
/// the same bits on every machine.
SinCos sin_cos(double angle_rad);

}  // namespace sunder
