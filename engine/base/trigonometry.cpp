#include "engine/base/trigonometry.h"

#include <cmath>

namespace sunder {
namespace {

// Taylor polynomials for |x| <= pi/4. The first omitted term is below 1e-17.
double sin_poly(double x) {
  const double z = x * x;
  double sum = -1.0 / 1307674368000.0;
  sum = sum * z + 1.0 / 6227020800.0;
  sum = sum * z - 1.0 / 39916800.0;
  sum = sum * z + 1.0 / 362880.0;
  sum = sum * z - 1.0 / 5040.0;
  sum = sum * z + 1.0 / 120.0;
  sum = sum * z - 1.0 / 6.0;
  return x + x * z * sum;
}

double cos_poly(double x) {
  const double z = x * x;
  double sum = 1.0 / 20922789888000.0;
  sum = sum * z - 1.0 / 87178291200.0;
  sum = sum * z + 1.0 / 479001600.0;
  sum = sum * z - 1.0 / 3628800.0;
  sum = sum * z + 1.0 / 40320.0;
  sum = sum * z - 1.0 / 720.0;
  sum = sum * z + 1.0 / 24.0;
  sum = sum * z - 0.5;
  return 1.0 + z * sum;
}

}  // namespace

SinCos sin_cos(double angle_rad) {
  // pi/2 as the sum of two parts (Cody and Waite), so that the reduction keeps the low bits.
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  const double quarter = std::floor(angle_rad / (kHalfPiHigh + kHalfPiLow) + 0.5);
  const double x = (angle_rad - quarter * kHalfPiHigh) - quarter * kHalfPiLow;
  const double s = sin_poly(x), c = cos_poly(x);
  switch (static_cast<long long>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double arc_tangent(double y, double x) {
  constexpr double kPi = 3.14159265358979323846;
  const double abs_y = std::abs(y), abs_x = std::abs(x);
  if (!(abs_y > 0) && !(abs_x > 0)) return 0;
  const bool is_steep = abs_y > abs_x;
  // Halving the angle twice gives |t| < 0.2, for which the series needs few terms.
  double t = is_steep ? abs_x / abs_y : abs_y / abs_x;
  t = t / (1 + std::sqrt(1 + t * t));
  t = t / (1 + std::sqrt(1 + t * t));
  const double z = t * t;
  constexpr double kSeries[] = {1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11,
                                1.0 / 9,  1.0 / 7,  1.0 / 5,  1.0 / 3,  1.0};
  double sum = 1.0 / 23;
  for (const double term : kSeries) sum = term - z * sum;
  const double angle = 4 * t * sum;
  const double first_quadrant = is_steep ? kPi / 2 - angle : angle;
  const double upper = x < 0 ? kPi - first_quadrant : first_quadrant;
  return y < 0 ? -upper : upper;
}

}  // namespace sunder
