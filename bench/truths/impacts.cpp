// Validation of impacts with restitution: rebound, transfer and conservation.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/random.h"

namespace sunder::truths {
namespace {

BodyDesc elastic(const BodyDesc& desc, double friction = 0) {
  return W::with_friction(desc, friction, 1);
}

/// Relative error of the time for which a ball bounces that falls from 1 m.
double time_of_bounces(const Preset& preset) {
  const double restitution = 0.5;
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.5, restitution));
  const BodyId ball =
      world.add(W::with_friction(W::sphere(0.1, Vec3(0, 1.1, 0)), 0.5, restitution));
  double time_s = 0, last_s = 0;
  world.watch(3, [&] {
    const BodyState s = world.state(ball);
    time_s += preset.dt_s;
    if (s.X_WB.position.y() > 0.1005 || std::abs(s.velocity_W.y()) > 0.05) last_s = time_s;
  });
  return last_s / (std::sqrt(2 / kG) * (1 + restitution) / (1 - restitution)) - 1;
}

double apex(const Preset& preset) {
  const double restitution = 0.8;
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.5, restitution));
  const BodyId ball =
      world.add(W::with_friction(W::sphere(0.1, Vec3(0, 1.1, 0)), 0.5, restitution));
  double highest_m = 0;
  bool rising = false, falls_again = false;
  world.watch(2, [&] {
    const BodyState s = world.state(ball);
    rising = rising || s.velocity_W.y() > 1;
    falls_again = falls_again || (rising && s.velocity_W.y() < 0);
    if (rising && !falls_again) highest_m = std::max(highest_m, s.X_WB.position.y() - 0.1);
  });
  return highest_m / (restitution * restitution) - 1;
}

/// Errors after a central collision of two balls.
struct Collision {
  double energy = 0;    ///< Energy lost in excess of theory, divided by the energy before.
  double momentum = 0;  ///< Change of momentum, divided by the sum of the magnitudes.
};
Collision two_balls(const Preset& preset, double restitution) {
  PresetWorld world(preset, Vec3::Zero());
  const auto ball = [&](double radius_m, double x_m, double speed_m_s) {
    return W::with_friction(W::moving(W::sphere(radius_m, Vec3(x_m, 0, 0)), Vec3(speed_m_s, 0, 0)),
                            0, restitution);
  };
  const BodyDesc a = ball(0.1, -1, 5), b = ball(0.15, 0.1, -1);
  world.add(a), world.add(b);
  const double before_J = world.kinetic_energy();
  const Vec3 momentum = world.momentum();
  world.run(0.5);
  const double reduced_kg = a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg);
  const double theory_J = 0.5 * reduced_kg * (1 - restitution * restitution) * 36;
  return {(before_J - world.kinetic_energy() - theory_J) / before_J,
          (world.momentum() - momentum).norm() / (5 * a.mass_kg + b.mass_kg)};
}
Measure lost_energy(double restitution) {
  return [=](const Preset& p) { return two_balls(p, restitution).energy; };
}

double momentum_of_all(const Preset& preset) {
  double worst = 0;
  for (const double restitution : {0.0, 0.5, 1.0})
    worst = std::max(worst, two_balls(preset, restitution).momentum);
  return worst;
}

/// Largest error of a speed in a cradle of five balls, `struck` of which arrive at 1 m/s.
Measure cradle(double gap_m, int struck) {
  return [=](const Preset& preset) {
    PresetWorld world(preset, Vec3::Zero());
    for (int i = 0; i < 5; ++i) {
      const bool arrives = i < struck;
      const Vec3 at(i * (0.2 + gap_m) - (arrives ? 0.3 : 0), 0, 0);
      world.add(elastic(W::moving(W::sphere(0.1, at), Vec3(arrives ? 1 : 0, 0, 0))));
    }
    world.run(1.5);
    double worst = 0;
    for (int i = 0; i < 5; ++i) {
      const double truth = i < 5 - struck ? 0 : 1;
      const Vec3 v = world.state(world.id(static_cast<std::size_t>(i))).velocity_W;
      worst = std::max(worst, std::abs(v.x() - truth));
    }
    return worst;
  };
}

/// Largest angular speed of a cube that falls flat from 1 m.
double spin_of_dropped_cube(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.5, 0.6));
  const BodyId cube = world.add(W::with_friction(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)), 0.5, 0.6));
  double most = 0;
  world.watch(1.5, [&] { most = std::max(most, world.state(cube).angular_velocity_W.norm()); });
  return most;
}

double energy_of_ten_cubes(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  for (int i = 0; i < 10; ++i) {
    const BodyDesc cube = W::box(Vec3::Constant(0.2), Vec3(0.25 * i, 0, 0));
    world.add(elastic(W::moving(cube, Vec3(i == 0 ? 3 : 0, 0, 0)), 0.3));
  }
  const double first_J = world.kinetic_energy();
  double most_J = first_J;
  world.watch(3, [&] { most_J = std::max(most_J, world.kinetic_energy()); });
  return most_J / first_J - 1;
}

/// Largest relative change of angular momentum of twenty pairs of rotating boxes off-centre.
Measure hulls_off_centre(double speed_m_s, double restitution) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(seed, 7);
      PresetWorld world(preset, Vec3::Zero());
      for (const double side : {-1.0, 1.0}) {
        const Vec3 size(random.uniform(0.3, 0.8), random.uniform(0.3, 0.8),
                        random.uniform(0.3, 0.8));
        const Vec3 at(1.5 * side, random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15));
        world.add(
            W::with_friction(W::moving(W::box(size, at, side < 0 ? 2000 : 1000),
                                       Vec3(-0.5 * side * speed_m_s, 0, 0), 5 * random.direction()),
                             0.6, restitution));
      }
      const Vec3 before = world.angular_momentum();
      world.run(6 / speed_m_s + 0.3);
      worst = std::max(worst, (world.angular_momentum() - before).norm() / before.norm());
    }
    return worst;
  };
}

/// Relative change of energy of elastic balls in a box in ten seconds.
double balls_in_box(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      BodyDesc wall = elastic(W::ground(side * Vec3::Unit(axis)));
      wall.X_WB.position = -1.5 * side * Vec3::Unit(axis);
      world.add(wall);
    }
  }
  Random random(3, 1);
  for (int i = 0; i < 216; ++i) {
    const Vec3 at = 0.4 * Vec3(i % 6 - 2.5, i / 6 % 6 - 2.5, i / 36 - 2.5);
    world.add(elastic(W::moving(W::sphere(0.1, at), 3 * random.direction())));
  }
  const double first_J = world.kinetic_energy();
  world.run(10);
  return world.kinetic_energy() / first_J - 1;
}

}  // namespace

Truths impact_truths() {
  return {
      truth(4, "bouncing ball, e = .5: time to rest", "", "√(2h/g) (1+e)/(1−e)", 0.01,
            time_of_bounces, {0.031, 0.025, 0.025, 0.013}),
      truth(4, "bouncing ball, e = .8: apex", "", "e² h", 0.01, apex,
            {0.0019, 0.001, 0.001, 0.001}),
      truth(14, "cradle of 5 touching, 1 in: worst speed", "", "1 out", 0.01, cradle(0, 1),
            {0.001, 0.001, 0.001, 0.001}),
      truth(14, "cradle of 5, 1 mm apart, 1 in: worst speed", "", "1 out", 0.01, cradle(1e-3, 1),
            {0.001, 0.001, 0.001, 0.001}),
      truth(14, "cradle of 5, 20 mm apart, 1 in: worst speed", "", "1 out", 0.01, cradle(0.02, 1),
            {0.001, 0.001, 0.001, 0.001}),
      truth(14, "cradle of 5, 1 mm apart, 2 in: worst speed", "", "2 out", 0.01, cradle(1e-3, 2),
            {0.001, 0.001, 0.001, 0.001}),
      truth(15, "two balls, e = 0: lost energy", "", "½ μ (1 − e²) v²", 0.005, lost_energy(0),
            {0.0005, 0.0005, 0.0005, 0.0005}),
      truth(15, "two balls, e = .5: lost energy", "", "½ μ (1 − e²) v²", 0.005, lost_energy(0.5),
            {0.0005, 0.0005, 0.0005, 0.0005}),
      truth(15, "two balls, e = 1: lost energy", "", "0", 0.005, lost_energy(1),
            {0.0005, 0.0005, 0.0005, 0.0005}),
      truth(15, "two balls: momentum", "", "constant", 1e-6, momentum_of_all,
            {1e-7, 1e-7, 1e-7, 1.3e-7}),
      truth(24, "216 elastic balls in a box, 10 s: energy", "", "constant", 0.05, balls_in_box,
            {0.005, 0.005, 0.005, 0.005}),
      truth(28, "hulls off-centre at 3 m/s, e = 0: L, worst of 20", "", "constant", 1e-5,
            hulls_off_centre(3, 0), {1e-05, 0.00099, 4.9e-05, 6.7e-05}),
      truth(28, "hulls off-centre at 30 m/s, e = 0: L, worst of 20", "", "constant", 1e-5,
            hulls_off_centre(30, 0), {0.0073, 0.0031, 0.0047, 5.6e-06}),
      truth(28, "hulls off-centre at 30 m/s, e = .5: L, worst of 20", "", "constant", 1e-5,
            hulls_off_centre(30, 0.5), {1e-05, 1e-06, 1e-06, 1e-06}),
      truth(32, "cube dropped flat, e = .6: spin", "rad/s", "0", 0.05, spin_of_dropped_cube,
            {0.005, 0.005, 0.005, 0.005}),
      truth(32, "ten cubes 50 mm apart, e = 1: energy gained", "", "0", 1e-6, energy_of_ten_cubes,
            {1e-7, 1e-7, 1e-7, 2.4e-7}),
  };
}

}  // namespace sunder::truths
