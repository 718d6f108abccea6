// Validation of Coulomb friction: sliding, braking distances and toppling.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"

namespace sunder::truths {
namespace {

/// Returns gravity in a frame whose x axis points down the slope.
Vec3 down_slope(double slope_rad) {
  const SinCos a = sin_cos(slope_rad);
  return kG * Vec3(a.sin, -a.cos, 0);
}

/// Motion in two seconds of a block on a slope `beyond_deg` steeper than its angle of friction.
struct Slide {
  double distance_m, theory_m;  ///< Travelled, and by theory from the speed at the start.
  double error_deg;  ///< Error of the angle of friction that follows from the acceleration.
};
Slide slide(const Preset& preset, double beyond_deg) {
  const double friction = 0.5, slope_rad = std::atan(friction) + beyond_deg * kPi / 180;
  PresetWorld world(preset, down_slope(slope_rad));
  world.add(W::with_friction(W::ground(), friction));
  const BodyId id = world.add(W::with_friction(W::box(Vec3(1, 0.4, 1), Vec3(0, 0.2, 0)), friction));
  world.run(0.5);  // contact settles
  const BodyState start = world.state(id);
  world.run(2);
  const SinCos a = sin_cos(slope_rad);
  const double pull = std::max(0.0, a.sin - friction * a.cos);
  const double distance_m = world.state(id).X_WB.position.x() - start.X_WB.position.x();
  const double theory_m = 2 * start.velocity_W.x() + 0.5 * kG * pull * 4;
  const double error_rad = (distance_m - theory_m) / (0.5 * kG * (a.cos + friction * a.sin) * 4);
  return {distance_m, theory_m, error_rad * 180 / kPi};
}

double braking_distance(const Preset& preset) {
  const double friction = 0.4, speed_m_s = 3;
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), friction));
  const BodyDesc block = W::with_friction(W::box(Vec3(1, 0.2, 1), Vec3(0, 0.1, 0)), friction);
  const BodyId id = world.add(block);
  world.run(0.25);
  world.physics().apply_impulse(id, Vec3(speed_m_s * block.mass_kg, 0, 0),
                                world.state(id).X_WB.position);
  world.run(2);
  return world.state(id).X_WB.position.x() * 2 * friction * kG / (speed_m_s * speed_m_s) - 1;
}

/// A rotating square block on four contact points at radius r; friction has the torque mu m g r.
double twist(const Preset& preset) {
  const double friction = 0.4, speed_rad_s = 3, side = 1, height = 0.2;
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), friction));
  const BodyDesc block =
      W::with_friction(W::box(Vec3(side, height, side), Vec3(0, height / 2, 0)), friction);
  const BodyId id = world.add(block);
  world.run(0.5);
  const double inertia = block.inertia_B(1, 1), r = std::sqrt(0.5) * side;
  const Vec3 kick(0, 0, 0.5 * speed_rad_s * inertia / (side / 2));
  world.physics().apply_impulse(id, kick, Vec3(-side / 2, 0, 0) + world.state(id).X_WB.position);
  world.physics().apply_impulse(id, -kick, Vec3(side / 2, 0, 0) + world.state(id).X_WB.position);
  const Quat before = world.state(id).X_WB.rotation;
  world.run(2);
  const Quat turn = before.conjugate() * world.state(id).X_WB.rotation;
  const double angle = 2 * std::atan2(std::abs(turn.y()), std::abs(turn.w()));
  const double truth =
      0.5 * inertia * speed_rad_s * speed_rad_s / (friction * block.mass_kg * kG * r);
  return angle / truth - 1;
}

/// Speed that a block of 9 mm/s gains in two seconds on a slope at its angle of friction.
double gain_of_slow_slider(const Preset& preset) {
  const double friction = 0.5, speed_m_s = 0.009;
  PresetWorld world(preset, down_slope(std::atan(friction)));
  world.add(W::with_friction(W::ground(), friction));
  BodyDesc block = W::with_friction(W::box(Vec3(0.4, 0.2, 0.3), Vec3(0, 0.1, 0)), friction);
  block.velocity_W.x() = speed_m_s;
  const BodyId id = world.add(block);
  world.run(2);
  return world.state(id).velocity_W.x() - speed_m_s;
}

/// Largest vertical speed in m/s or rotation in rad/s of a block of 1 m that brakes from 0.3 m/s.
double kick_of_slow_slider(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 0.5));
  BodyDesc block = W::with_friction(W::box(Vec3(1, 0.5, 1), Vec3(0, 0.25, 0)), 0.5);
  block.velocity_W = Vec3(0.3, 0, 0);
  const BodyId id = world.add(block);
  double most_m_s = 0;
  world.watch(0.5, [&] {
    const BodyState s = world.state(id);
    most_m_s = std::max({most_m_s, std::abs(s.velocity_W.y()), s.angular_velocity_W.norm()});
  });
  return most_m_s;
}

/// Returns true if a block of 0.5 by 1 m topples on the slope.
bool topples(const Preset& preset, double slope_rad) {
  PresetWorld world(preset, down_slope(slope_rad));
  world.add(W::with_friction(W::ground(), 1));
  const BodyId id = world.add(W::with_friction(W::box(Vec3(0.5, 1, 1), Vec3(0, 0.5, 0)), 1));
  world.run(6);
  return world.state(id).X_WB.position.y() < 0.45;
}

double toppling_angle_deg(const Preset& preset) {
  const double truth = std::atan(0.5);
  const double found = threshold(truth - 0.05, truth + 0.05, 12,
                                 [&](double slope) { return topples(preset, slope); });
  return (found - truth) * 180 / kPi;
}

/// Height of two cards that lean on each other along a line 10 mm high, 1 m apart at their feet.
constexpr double kRidgeHeight_m = 1;

bool cards_slip(const Preset& preset, double friction) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), friction));
  BodyId card;
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vec3> corners;
    for (const double z : {-0.25, 0.25})
      for (const double y : {0.0, 0.01}) {
        corners.emplace_back(0.5 * side, y, z);
        corners.emplace_back(0, kRidgeHeight_m - 0.01 + y, z);
      }
    const ConvexPolyhedron hull = make_hull(corners);
    card = world.add(W::with_friction(W::hull(hull, mass_properties(hull).centroid), friction));
  }
  const double before_m = world.state(card).X_WB.position.y();
  world.run(3);
  return world.state(card).X_WB.position.y() < 0.9 * before_m;
}

/// In theory the ridge pushes with half the weight / tan φ, which friction at the foot balances.
double cards_friction(const Preset& preset) {
  const double truth = 0.5 * 0.5 / kRidgeHeight_m;
  const double least_friction = threshold(
      0.8 * truth, 1.2 * truth, 7, [&](double friction) { return !cards_slip(preset, friction); });
  return least_friction / truth - 1;
}

/// Largest rise of energy above its minimum so far, relative to the start, of a rod that slides on
/// its end with friction above Painlevé's limit.
double painleve_gain(const Preset& preset) {
  const double angle_rad = kPi / 3, friction = 2.2;  // Painlevé's limit is 1.35
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), friction));
  const SinCos a = sin_cos(angle_rad);
  BodyDesc rod = W::with_friction(
      W::box(Vec3(1, 0.02, 0.02), Vec3(0, 0.5 * a.sin + 0.01 * a.cos, 0)), friction);
  rod.X_WB.rotation = Quat(Eigen::AngleAxisd(-angle_rad, Vec3::UnitZ()));
  rod.velocity_W = Vec3(5, 0, 0);
  world.add(rod);
  const auto energy = [&] { return world.kinetic_energy() + world.potential_energy(kG); };
  const double first_J = energy();
  double least_J = first_J, gain = 0;
  world.watch(2, [&] {
    least_J = std::min(least_J, energy());
    gain = std::max(gain, (energy() - least_J) / first_J);
  });
  return gain;
}

}  // namespace

Truths friction_truths() {
  return {
      truth(1, "block on a slope 0.1° less steep than its friction: creep in 2 s", "mm", "Coulomb",
            0.2, [](const Preset& p) { return 1e3 * slide(p, -0.1).distance_m; },
            {0.02, 0.02, 0.02, 0.02}),
      truth(1, "block on a slope 0.1° steeper: its angle of friction", "°", "Coulomb", 0.1,
            [](const Preset& p) { return slide(p, 0.1).error_deg; }, {0.01, 0.054, 0.027, 0.01}),
      truth(2, "block on a slope 5° steeper: way in 2 s", "", "g (sin θ − μ cos θ) t²/2", 0.002,
            [](const Preset& p) {
              const Slide s = slide(p, 5);
              return s.distance_m / s.theory_m - 1;
            },
            {0.0011, 0.0011, 0.00053, 0.00023}),
      truth(2, "braking distance", "", "v²/2μg", 0.002, braking_distance,
            {0.0034, 0.0031, 0.002, 0.0011}),
      truth(2, "turning block: angle to rest", "", "I ω²/2 over μ m g r", 0.002, twist,
            {0.013, 0.013, 0.0064, 0.0032}),
      truth(2, "block of 1 m that brakes from 0.3 m/s: lifted or turned", "m/s", "rigid", 0.01,
            kick_of_slow_slider, {0.001, 0.0016, 0.001, 0.001}),
      truth(2, "block that creeps down a slope of its friction: speed it gains", "m/s", "none",
            0.001, gain_of_slow_slider, {1e-4, 1e-4, 1e-4, 1e-4}),
      truth(3, "block on a slope: angle where it topples", "°", "tan α = b/h", 0.02,
            toppling_angle_deg, {0.002, 0.002, 0.002, 0.002}),
      truth(12, "two leaning cards: least friction", "", "μ = 1/(2 tan φ)", 0.02, cards_friction,
            {0.0024, 0.0024, 0.0024, 0.0024}),
      truth(21, "Painlevé's rod at μ = 2.2: energy rises", "",
            "Painlevé 1895; no energy from friction", 1e-6, painleve_gain,
            {1e-06, 0.001, 1e-06, 1e-06}),
  };
}

}  // namespace sunder::truths
