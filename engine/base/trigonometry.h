// sin, cos and arc tangent from polynomials: the C library's differ between processors, and
// simulated state may not.
#pragma once

namespace sunder {

struct SinCos {
  double sin;
  double cos;
};

/// Sine and cosine of an angle with |angle| <= 1e6 rad, within 4e-16 absolutely after reduction;
/// the same bits on every machine.
SinCos sin_cos(double angle_rad);

/// The angle of (x, y) from the x-axis, in [-pi, pi], within 1e-15; 0 for (0, 0). The same bits on
/// every machine.
double arc_tangent(double y, double x);

}  // namespace sunder
