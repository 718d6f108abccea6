#include "scenes/sculpture/hills.h"

#include <cmath>

#include "engine/base/random.h"

namespace sunder::scenes {
namespace {

constexpr int kOctaves = 3;
/// Frequency and amplitude of an octave, relative to the one before.
constexpr double kFrequencyRatio = 2, kAmplitudeRatio = 0.35;

/// Returns gradient noise: 0 at all points of the integer lattice, with a random gradient at each,
/// and values from about −0.7 to 0.7 between.
double noise(double x, double z, std::uint64_t seed) {
  const double column = std::floor(x), row = std::floor(z);
  const auto at = [&](int i, int k) {
    const auto cell = [](double c) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(c));
    };
    Random random(combine(seed, cell(column + i)), cell(row + k));
    const double slope_x = random.uniform(-1, 1), slope_z = random.uniform(-1, 1);
    return slope_x * (x - column - i) + slope_z * (z - row - k);
  };
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double u = fade(x - column), w = fade(z - row);
  const double near = at(0, 0) + u * (at(1, 0) - at(0, 0));
  const double far = at(0, 1) + u * (at(1, 1) - at(0, 1));
  return near + w * (far - near);
}

}  // namespace

std::vector<double> make_hills(const Hills& hills) {
  std::vector<double> heights;
  heights.reserve(hills.rows * hills.columns);
  for (std::size_t row = 0; row < hills.rows; ++row) {
    for (std::size_t column = 0; column < hills.columns; ++column) {
      // Neighbouring tops and valleys are about one cell of the lattice apart.
      double cells = 2 * hills.spacing_m / hills.length_m, high_m = hills.height_m, height_m = 0;
      for (int octave = 0; octave < kOctaves; ++octave) {
        height_m +=
            high_m * noise(cells * static_cast<double>(column), cells * static_cast<double>(row),
                           combine(hills.seed, static_cast<std::uint64_t>(octave)));
        cells *= kFrequencyRatio, high_m *= kAmplitudeRatio;
      }
      heights.push_back(height_m);
    }
  }
  return heights;
}

}  // namespace sunder::scenes
