// Sine, cosine and arc tangent by polynomials. The C library's functions give different bits on
// different processors, which simulated state must not.
#pragma once

namespace sunder {

struct SinCos {
  double sin;
  double cos;
};

/// Returns sine and cosine of an angle, |angle| <= 1e6 rad, with an absolute error of at most 4e-16
/// after reduction. Gives the same bits on every machine.
SinCos sin_cos(double angle_rad);

/// Returns the angle of (x, y) from the x-axis in rad, in [-pi, pi], with an error of at most
/// 1e-15; 0 for (0, 0). Gives the same bits on every machine.
double arc_tangent(double y, double x);

}  // namespace sunder
