// Scenes of SimBenchmark (Hwangbo et al., leggedrobotics.github.io/SimBenchmark) with rigid bodies
// only, at its step of 1 ms, with a preset's substeps and sweeps. Its results are means of squares
// over all steps: m² summed over all contacts, or J².
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/random.h"

namespace sunder::truths {
namespace {

constexpr double kRadius_m = 0.1;

Preset at_a_millisecond(Preset preset) {
  preset.dt_s = 1e-3;
  return preset;
}

BodyDesc ball(const Vec3& at, double restitution) {
  const double volume_m3 = W::sphere(kRadius_m, at, 1).mass_kg;
  return W::with_friction(W::sphere(kRadius_m, at, 10 / volume_m3), 0, restitution);
}

/// Adds the scene "666": 6 x 6 x 6 frictionless balls in nearly straight rows that fall 1 m.
void add_cube(PresetWorld& world, double restitution) {
  world.add(W::with_friction(W::ground(), 0, restitution));
  Random random(42);
  for (int i = 0; i < 216; ++i) {
    const Vec3 jitter(random.uniform(), random.uniform(), random.uniform());
    const Vec3 cell(i % 6, i / 36, i / 6 % 6);
    world.add(ball(0.21 * cell + 1e-3 * jitter + Vec3(0, 1.101, 0), restitution));
  }
}

double penetration(const Preset& preset) {
  PresetWorld world(at_a_millisecond(preset));
  add_cube(world, 0);
  double sum = 0;
  int steps = 0;
  world.watch(10, [&] {
    for (const float depth : world.physics().penetrations())
      sum += std::pow(static_cast<double>(depth), 2);
    ++steps;
  });
  return sum / steps;
}

/// Mean square of the deviation of the energy from its start.
double energy_error(PresetWorld& world, double time_s) {
  const auto energy = [&] { return world.kinetic_energy() + world.potential_energy(kG); };
  const double first_J = energy();
  double sum = 0;
  int steps = 0;
  world.watch(time_s, [&] { sum += std::pow(energy() - first_J, 2), ++steps; });
  return sum / steps;
}

double elastic_energy(const Preset& preset) {
  PresetWorld world(at_a_millisecond(preset));
  add_cube(world, 1);
  return energy_error(world, 10);
}

/// 7 x 7 balls that bounce from a height of 5 m and do not collide with each other.
double bouncing_energy(const Preset& preset) {
  PresetWorld world(at_a_millisecond(preset));
  world.add(W::with_friction(W::ground(), 0, 1));
  for (int i = 0; i < 49; ++i) world.add(ball(Vec3(0.4 * (i % 7), 5, 0.4 * (i / 7)), 1));
  return energy_error(world, 20);
}

}  // namespace

Truths sphere_truths() {
  return {
      truth(23, "216 balls that collapse: penetration", "m²", "2 x RaiSim's 1.35e-4, SimBenchmark",
            2.7e-4, penetration, {2.7e-5, 2.7e-5, 2.7e-5, 2.7e-5}),
      truth(23, "216 elastic balls that collapse: energy", "J²", "2 x RaiSim's 8.4, SimBenchmark",
            16.8, elastic_energy, {1.7, 1.7, 1.7, 1.7}),
      truth(24, "49 elastic balls from 5 m, 20 s: energy", "J²", "2 x RaiSim's .0186, SimBenchmark",
            0.0372, bouncing_energy, {0.0037, 0.0037, 0.0037, 0.0037}),
  };
}

}  // namespace sunder::truths
