#include "engine/base/exponential.h"

#include <cmath>
#include <numbers>

namespace sunder {
namespace {

// ln 2 as the sum of two parts. The product of kLn2High and an integer below 2^20 is exact.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;

}  // namespace

double natural_logarithm(double x) {
  int power = 0;
  double mantissa = std::frexp(x, &power);  // 0.5 to 1
  if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --power;
  // ln m = 2 artanh t with t = (m - 1) / (m + 1), |t| <= 0.172.
  const double t = (mantissa - 1) / (mantissa + 1), square = t * t;
  double sum = 0;
  for (int i = 23; i >= 1; i -= 2) sum = sum * square + 1.0 / i;
  return power * kLn2High + (2 * t * sum + power * kLn2Low);
}

double binary_logarithm(double x) {
  int power = 0;
  const double mantissa = 2 * std::frexp(x, &power);  // 1 to 2
  return (power - 1) + natural_logarithm(mantissa) / std::numbers::ln2;
}

double exponential(double x) {
  const double power = std::floor(x / std::numbers::ln2 + 0.5);
  const double rest = (x - power * kLn2High) - power * kLn2Low;  // |rest| <= 0.35
  double sum = 1;
  for (int i = 16; i >= 1; --i) sum = 1 + sum * rest / i;
  return std::ldexp(sum, static_cast<int>(power));
}

}  // namespace sunder
