// Validation of extreme bodies: no gain of energy, no tunnelling, and rest in the end.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/random.h"

namespace sunder::truths {
namespace {

/// Returns the largest relative rise of energy above its start; not finite if a state is not.
double energy_gained(PresetWorld& world, double time_s) {
  const auto energy = [&] { return world.kinetic_energy() + world.potential_energy(kG); };
  const double first_J = energy();
  double most = 0;
  world.watch(time_s, [&] {
    const double gain = energy() / first_J - 1;
    if (!(gain <= most)) most = gain;
  });
  return most;
}

double fastest_sliver(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const Vec3 size = i % 2 == 0 ? Vec3(1, 0.001, 0.001) : Vec3(1, 0.001, 0.5);
    BodyDesc sliver = W::box(size, Vec3(0.1 * (i % 4), 0.2 + 0.1 * i, 0.1 * (i % 3)));
    sliver.X_WB.rotation = Quat(Eigen::AngleAxisd(random.uniform(0, 1), random.direction()));
    world.add(sliver);
  }
  world.run(8);
  double fastest = 0;
  for (std::size_t i = 1; i < world.size(); ++i) {
    const BodyState s = world.state(world.id(i));
    const bool fell_through = !(s.X_WB.position.y() > -0.01);
    fastest = std::max(fastest, fell_through ? 1e3 : s.velocity_W.norm());
  }
  return fastest;
}

double plates_and_needles(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  for (int i = 0; i < 12; ++i) {
    const Vec3 size = i % 2 == 0 ? Vec3(0.5, 1e-4, 0.5) : Vec3(1e-4, 1, 1e-4);
    world.add(W::moving(W::box(size, Vec3(0.3 * i, 1.5, 0)), Vec3::Zero(), Vec3(100, 30, -60)));
  }
  return energy_gained(world, 2);
}

/// Largest gain of energy of one box on another, over four mass ratios.
double mass_ratios(const Preset& preset) {
  double worst = 0;
  for (const double ratio : {1e-6, 1e-3, 1e3, 1e6}) {
    PresetWorld world(preset);
    world.add(W::ground());
    world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
    world.add(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0), 1000 * ratio));
    worst = std::max(worst, energy_gained(world, 2));
  }
  return worst;
}

/// Largest displacement of a box at rest on one that is a thousand or a million times heavier.
double light_on_heavy_mm(const Preset& preset) {
  double worst_m = 0;
  for (const double ratio : {1e-6, 1e-3}) {
    PresetWorld world(preset);
    world.add(W::ground());
    world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
    const BodyId top = world.add(W::box(Vec3(1, 1, 1), Vec3(0, 1.5, 0), 1000 * ratio));
    world.run(2);
    worst_m = std::max(worst_m, (world.state(top).X_WB.position - Vec3(0, 1.5, 0)).norm());
  }
  return 1e3 * worst_m;
}

double stack_of_thousand(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  for (int i = 0; i < 1000; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5 + i, 0)));
  return energy_gained(world, 5);
}

/// Number of balls and boxes, shot at anchored and free walls, that pass or gain energy.
double shots_that_pass(const Preset& preset) {
  int passed = 0;
  for (int shot = 0; shot < 36; ++shot) {
    const double speed_m_s = std::array{25.0, 200.0, 1000.0}[shot % 3U];
    const double thick_m = std::array{0.1, 0.05, 0.01}[shot / 3 % 3U];
    const bool held = shot / 9 % 2 == 0, ball = shot / 18 == 0;
    PresetWorld world(preset, Vec3::Zero());
    const BodyDesc wall = W::box(Vec3(thick_m, 2, 2), Vec3::Zero(), 8000);
    const BodyId wall_id = world.add(held ? W::fixed(wall) : wall);
    const Vec3 from(-3.3, 0.01, 0);
    const BodyDesc body = ball ? W::sphere(0.1, from) : W::box(Vec3::Constant(0.2), from);
    const BodyId id = world.add(W::moving(body, Vec3(speed_m_s, 0, 0)));
    const double first_J = world.kinetic_energy();
    world.run(0.2);
    const double gap_m = world.state(wall_id).X_WB.position.x() - world.state(id).X_WB.position.x();
    const bool stopped = gap_m > 0.5 * thick_m + 0.09;
    passed += !(stopped && world.kinetic_energy() <= first_J * (1 + 1e-6));
  }
  return passed;
}

/// Change of velocity of a ball that passes a wall at a distance of 2 cm.
double near_miss(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  world.add(W::fixed(W::box(Vec3(0.2, 2, 2), Vec3::Zero())));
  const BodyId id = world.add(W::moving(W::sphere(0.1, Vec3(-3.3, 1.12, 0)), Vec3(200, 0, 0)));
  world.run(0.1);
  return (world.state(id).velocity_W - Vec3(200, 0, 0)).norm();
}

/// Kinetic energy of boxes that overlap by half, divided by its limit in overlap resolution.
double half_overlaps(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  const double side_m = 0.2;
  double allowed_J = 0, most_J = 0;
  for (int i = 0; i < 125; ++i) {
    const Vec3 cell(i % 5, i / 5 % 5, i / 25);
    const BodyDesc box = W::box(Vec3::Constant(side_m), 0.1 * cell);
    allowed_J += 0.5 * box.mass_kg * 16 * 0.5 * side_m;  // limit 4 √(g h); g = 1 without gravity
    world.add(box);
  }
  world.watch(1, [&] {
    const double now_J = world.kinetic_energy();
    if (!(now_J <= most_J)) most_J = now_J;
  });
  return most_J / allowed_J;
}

}  // namespace

Truths energy_truths() {
  const char* none = "no energy from nowhere";
  return {
      truth(37, "slivers of 1 : 1,000 after 8 s: fastest", "m/s", "rest", 0.1, fastest_sliver,
            {0.1, 0.1, 0.1, 0.1}),
      truth(38, "plates and needles that spin fast: energy gained", "", none, 1e-6,
            plates_and_needles, {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(39, "box on a box, mass ratios 1e-6 to 1e6: energy gained", "", none, 1e-6, mass_ratios,
            {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(39, "light box on one a thousand and a million times heavier: off its place", "mm",
            "rest", 0.2, light_on_heavy_mm, {0.02, 0.02, 0.02, 0.02}),
      truth(40, "stack of 1,000 for 5 s: energy gained", "", none, 1e-6, stack_of_thousand,
            {1e-07, 1e-07, 2.3e-06, 2.2e-06}),
      truth(41, "36 shots of up to 1,000 m/s at walls of 10 to 100 mm: pass", "", "none passes", 0,
            shots_that_pass, {0, 0, 0, 0}),
      truth(41, "ball that passes a wall by at 200 m/s: pushed", "m/s", "0", 1e-3, near_miss,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(42, "125 boxes that overlap by half: energy, of what an overlap may push", "",
            "docs/decisions/020", 1, half_overlaps, {0.1, 0.1, 0.1, 0.1}),
  };
}

}  // namespace sunder::truths
