// Validation of silo pressure (Janssen 1895), which approaches a limit with depth.
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/random.h"
#include "engine/base/trigonometry.h"

namespace sunder::truths {
namespace {

constexpr double kSilo_m = 0.15, kGrain_m = 0.02;  // radii
constexpr int kSilos = 4, kGrains = 750, kSides = 16, kBands = 8;
using Bands = std::array<double, kBands>;

/// Fraction of the variance of `y` that remains after a fit of A (1 − e^(−x/λ)) at x = 0.5, 1.5 ...
double unexplained_variance(const Bands& y) {
  double mean = 0, variance = 0, least = 1e30;
  for (const double value : y) mean += value / kBands;
  for (const double value : y) variance += (value - mean) * (value - mean);
  for (double length = 0.2; length < 20; length *= 1.01) {
    double along = 0, square = 0, left = 0;
    const auto rise = [&](int band) { return 1 - std::exp(-(band + 0.5) / length); };
    for (int i = 0; i < kBands; ++i)
      along += rise(i) * y[static_cast<std::size_t>(i)], square += rise(i) * rise(i);
    for (int i = 0; i < kBands; ++i)
      left += std::pow(y[static_cast<std::size_t>(i)] - along / square * rise(i), 2);
    least = std::min(least, left);
  }
  return least / variance;
}

/// Returns the horizontal impulse on the wall of one silo by depth, from the top down.
Bands wall_pressure(const Preset& preset, std::uint64_t seed) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.5));
  for (int i = 0; i < kSides; ++i) {
    const SinCos a = sin_cos(2 * kPi * i / kSides);
    const Vec3 out(a.cos, 0, a.sin);
    BodyDesc wall = W::with_friction(W::ground(-out), 0.5);
    wall.X_WB.position = kSilo_m * out;
    wall.reports_load = true;
    world.add(wall);
  }
  Random random(seed, 18);
  std::vector<BodyId> grains;
  for (int i = 0; i < kGrains; ++i) {
    const SinCos turn = sin_cos(2.4 * i);  // golden angle
    const double radius_m = 0.12 * std::sqrt((i % 20) / 20.0);
    const double size_m = kGrain_m * random.uniform(0.9, 1.1);
    grains.push_back(world.add(W::with_friction(
        W::sphere(size_m, Vec3(radius_m * turn.cos, 0.03 + 0.05 * (i / 20), radius_m * turn.sin)),
        0.5)));
  }
  world.run(2);
  double top_m = 0;
  for (const BodyId id : grains) top_m = std::max(top_m, world.state(id).X_WB.position.y());
  Bands pressure{};
  world.watch(0.5, [&] {
    for (const ContactImpulse& load : world.physics().contact_impulses()) {
      const double depth = (top_m - load.point_W.y()) / top_m * kBands;
      const auto band = static_cast<std::size_t>(std::clamp(depth, 0.0, kBands - 1.0));
      pressure[band] += std::hypot(load.impulse_W.x(), load.impulse_W.z());
    }
  });
  return pressure;
}

/// Unexplained variance of the mean over four silos, because arches form at random in each.
double silo(const Preset& preset) {
  Bands mean{};
  for (std::uint64_t seed = 1; seed <= kSilos; ++seed) {
    const Bands one = wall_pressure(preset, seed);
    for (std::size_t band = 0; band < kBands; ++band) mean[band] += one[band] / kSilos;
  }
  return unexplained_variance(mean);
}

}  // namespace

Truths silo_truths() {
  return {
      truth(18, "4 silos of 750 balls: 1 − R² of the walls' mean pressure over depth", "",
            "A (1 − e^(−z/λ)), Janssen 1895", 0.02, silo, {0.035, 0.024, 0.072, 0.038}),
  };
}

}  // namespace sunder::truths
