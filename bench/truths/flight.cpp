// Validation of free flight and rotation.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/random.h"
#include "engine/geometry/hull.h"

namespace sunder::truths {
namespace {

/// Conserved quantities of a world without external forces, relative to those at construction.
class Conserved {
 public:
  explicit Conserved(const RigidWorld& world)
      : world_(world),
        start_energy_J_(world.kinetic_energy()),
        start_momentum_(world.momentum()),
        start_angular_momentum_(world.angular_momentum()) {}

  double energy() const { return world_.kinetic_energy() / start_energy_J_ - 1; }
  double angular_momentum() const {
    return (world_.angular_momentum() - start_angular_momentum_).norm() /
           start_angular_momentum_.norm();
  }
  double angular_momentum_over(double scale) const {
    return (world_.angular_momentum() - start_angular_momentum_).norm() / scale;
  }
  double momentum_over(double scale) const {
    return (world_.momentum() - start_momentum_).norm() / scale;
  }

 private:
  const RigidWorld& world_;
  double start_energy_J_;
  Vec3 start_momentum_, start_angular_momentum_;
};

double parabola_m(const Preset& preset) {
  PresetWorld world(preset);
  const Vec3 start(0, 100, 0), velocity(3, 5, 0);
  const BodyId body = world.add(W::moving(W::box(Vec3(1, 1, 1), start), velocity));
  world.run(2);
  const Vec3 truth = start + 2 * velocity + 2 * Vec3(0, -kG, 0);
  return (world.state(body).X_WB.position - truth).norm();
}

/// A box that rotates about its middle axis for a minute and tumbles (Dzhanibekov effect).
double tumbler(const Preset& preset, double (Conserved::*error)() const) {
  PresetWorld world(preset, Vec3::Zero());
  world.add(W::moving(W::box(Vec3(1, 0.6, 0.2), Vec3::Zero()), Vec3::Zero(), Vec3(0.01, 10, 0.01)));
  const Conserved conserved(world);
  world.run(60);
  return (conserved.*error)();
}

/// The larger error of a slow and of a fast box.
double slab(const Preset& preset, double (Conserved::*error)() const) {
  double worst = 0;
  for (const double spin : {0.5, 5.0}) {
    PresetWorld world(preset, Vec3::Zero());
    world.add(W::moving(W::box(Vec3(1, 0.2, 0.5), Vec3::Zero()), Vec3::Zero(),
                        spin * Vec3(1, 2, 0.5).normalized()));
    const Conserved conserved(world);
    world.run(4);
    worst = std::max(worst, std::abs((conserved.*error)()));
  }
  return worst;
}

/// Boxes in contact that fly apart.
double fragments(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  Random random(5, 1);
  for (int i = 0; i < 48; ++i) {
    const Vec3 at = 0.21 * Vec3(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1);
    const Vec3 velocity = 4 * at + random.direction();
    world.add(W::with_friction(
        W::moving(W::box(Vec3::Constant(0.2), at), velocity, 10 * random.direction()), 0.6));
  }
  const Conserved conserved(world);
  world.run(1);
  return conserved.angular_momentum();
}

/// Sixty hulls that fly into each other. Errors are relative to the sum of their momenta, times 1
/// m.
double implosion(const Preset& preset, double (Conserved::*error)(double) const) {
  PresetWorld world(preset, Vec3::Zero());
  Random random(3);
  double thrown_Ns = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = 0.5 * Vec3(i % 4, i / 4 % 4, i / 16);
    std::vector<Vec3> points;
    for (int k = 0; k < 12; ++k) points.push_back(0.2 * random.direction());
    const BodyDesc hull = W::hull(make_hull(points), at);
    const Vec3 velocity = 2 * (Vec3(0.75, 0.75, 0.75) - at);
    thrown_Ns += hull.mass_kg * velocity.norm();
    world.add(W::moving(hull, velocity));
  }
  const Conserved conserved(world);
  world.run(2);
  return (conserved.*error)(thrown_Ns);
}

/// A flat box that rotates about its axis on ground without friction, by 2.5 rad per 1/60 s.
double spin_on_ground(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0));
  world.add(W::with_friction(
      W::moving(W::box(Vec3(0.4, 0.2, 0.4), Vec3(0, 0.1, 0)), Vec3::Zero(), Vec3(0, 150, 0)), 0));
  const Conserved conserved(world);
  world.run(1);
  return conserved.angular_momentum();
}

/// Largest change of momentum in a step of a heap of hulls without the external impulse of the
/// report, divided by the impulse of the heap's weight in one second.
double unreported_impulse(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::ground());
  Random random(5);
  double mass_kg = 0;
  for (int i = 0; i < 40; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < 12; ++k) points.push_back(random.uniform(0.1, 0.25) * random.direction());
    const Vec3 at(0.45 * (i % 4), 0.3 + 0.4 * (i / 16), 0.45 * (i / 4 % 4));
    const BodyDesc hull = W::hull(make_hull(points), at, 2000);
    mass_kg += hull.mass_kg;
    world.add(hull);
  }
  double worst_Ns = 0;
  for (int i = 0; i < 2 / preset.dt_s; ++i) {
    const Vec3 before = world.momentum();
    const SolveReport report = world.step();
    const Vec3 left = world.momentum() - before - report.external_impulse_Ns;
    worst_Ns = std::max(worst_Ns, left.norm());
  }
  return worst_Ns / (mass_kg * kG);
}

Measure energy_of(double (*run)(const Preset&, double (Conserved::*)() const)) {
  return [=](const Preset& p) { return run(p, &Conserved::energy); };
}
Measure spin_of(double (*run)(const Preset&, double (Conserved::*)() const)) {
  return [=](const Preset& p) { return run(p, &Conserved::angular_momentum); };
}

}  // namespace

Truths flight_truths() {
  return {
      truth(6, "free spinner about its middle axis, 60 s: E", "", "constant", 1e-3,
            energy_of(tumbler), {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(6, "free spinner about its middle axis, 60 s: L", "", "constant", 1e-6,
            spin_of(tumbler), {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(6, "tumbling slab, .5 and 5 rad/s, 4 s: E", "", "constant", 1e-6, energy_of(slab),
            {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(6, "tumbling slab, .5 and 5 rad/s, 4 s: L", "", "constant", 1e-6, spin_of(slab),
            {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(6, "box that spins at 150 rad/s on smooth ground, 1 s: L", "", "constant", 1e-4,
            spin_on_ground, {0.0033, 0.0012, 0.0008, 1e-05}),
      truth(16, "free fall, 2 s: place", "m", "parabola", 1e-9, parabola_m,
            {1e-10, 1e-10, 1e-10, 1e-10}),
      truth(16, "heap that settles: impulse not reported, of a second's weight", "", "constant",
            1e-6, unreported_impulse, {1e-7, 1e-7, 1e-7, 1e-7}),
      truth(28, "48 boxes fly apart in contact: L", "", "constant", 1e-5, fragments,
            {1.1e-05, 1.1e-05, 1e-05, 1.8e-05}),
      truth(28, "60 hulls fly into each other: p", "", "constant", 1e-6,
            [](const Preset& p) { return implosion(p, &Conserved::momentum_over); },
            {3.6e-7, 1.5e-7, 7.4e-07, 6e-7}),
      truth(28, "60 hulls fly into each other: L", "", "constant", 1e-5,
            [](const Preset& p) { return implosion(p, &Conserved::angular_momentum_over); },
            {1e-6, 1e-6, 1e-6, 1e-6}),
  };
}

}  // namespace sunder::truths
