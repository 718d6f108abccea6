// Counter-based random numbers: a value depends on (seed, stream, counter) only.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/base/hash.h"
#include "engine/base/types.h"

namespace sunder {

/// A generator of pseudorandom numbers; equal seeds and streams give equal sequences.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0)
      : key_(combine(seed, stream)) {}

  constexpr std::uint64_t bits() { return combine(key_, counter_++); }
  /// Returns a number uniform in [0, 1), with 53 random bits.
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns an integer uniform in [0, n), n > 0.
  constexpr std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32);
  }
  /// Returns a unit vector of uniform direction, by rejection sampling (without trigonometry).
  Vec3 direction() {
    for (;;) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
      const double square = x * x + y * y + z * z;
      if (square > 1e-4 && square <= 1) return Vec3(x, y, z) / std::sqrt(square);
    }
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace sunder
