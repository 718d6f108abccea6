#include "engine/base/roots.h"

#include "engine/base/exponential.h"

namespace sunder {

double cube_root(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  int power = 0;
  double m = std::frexp(std::abs(x), &power);
  for (; power % 3 != 0; ++power) m *= 0.5;          // m is from 1/8 to 1
  double root = 0.3969 + (0.9306 - 0.3275 * m) * m;  // within 4 % of the root
  for (int i = 0; i < 2; ++i) {                      // Halley's method: within 1e-13
    const double cube = root * root * root;
    root = root * (cube + 2 * m) / (2 * cube + m);
  }
  const double cube = root * root * root;
  root += root * (m - cube) / (2 * cube + m);
  return std::copysign(std::ldexp(root, power / 3), x);
}

double positive_power(double base, double exponent) {
  return exponential(exponent * natural_logarithm(base));
}

}  // namespace sunder
