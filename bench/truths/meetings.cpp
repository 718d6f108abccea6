// Validation of collisions in flight between bodies that move farther in a step than they are
// thick: positions and velocities by closed forms, at the preset's step and at 1/30 s.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"

namespace sunder::truths {
namespace {

constexpr double kSpeed_m_s = 500, kFlight_s = 0.1;

/// Two bodies after 0.1 s of flight.
struct PairAfterFlight {
  BodyState a, b;
  double momentum = 0;  ///< Change of momentum, divided by the larger of the two momenta.
};
PairAfterFlight fly_pair(const Preset& preset, const BodyDesc& a, const BodyDesc& b) {
  PresetWorld world(preset, Vec3::Zero());
  const BodyId id_a = world.add(W::with_friction(a, 0)), id_b = world.add(W::with_friction(b, 0));
  const Vec3 before = world.momentum();
  world.run(kFlight_s);
  const double scale = std::max(a.mass_kg * a.velocity_W.norm(), b.mass_kg * b.velocity_W.norm());
  return {world.state(id_a), world.state(id_b), (world.momentum() - before).norm() / scale};
}

/// Largest errors after a collision.
struct Errors {
  double place_m = 0, speed_m_s = 0, momentum = 0;
};

/// A light and a heavy body that collide centrally and then move at a common velocity.
Errors head_on(const Preset& preset, bool balls) {
  const double size_m = 0.1, start_m = 17.3;
  const Vec3 velocity = Vec3::UnitX() * kSpeed_m_s;
  const auto body = [&](double x_m, double density) {
    return balls ? W::sphere(0.5 * size_m, Vec3(x_m, 0, 0), density)
                 : W::box(Vec3::Constant(size_m), Vec3(x_m, 0, 0), density);
  };
  const PairAfterFlight after = fly_pair(preset, W::moving(body(-start_m, 1000), velocity),
                                         W::moving(body(start_m, 3000), -velocity));
  const double common_m_s = -0.5 * kSpeed_m_s;
  const double meet_s = (2 * start_m - size_m) / (2 * kSpeed_m_s);
  const double contact_m = start_m - 0.5 * size_m - kSpeed_m_s * meet_s +
                           common_m_s * (kFlight_s - meet_s);  // position of the contact at the end
  return {std::max(std::abs(after.a.X_WB.position.x() - (contact_m - 0.5 * size_m)),
                   std::abs(after.b.X_WB.position.x() - (contact_m + 0.5 * size_m))),
          std::max(std::abs(after.a.velocity_W.x() - common_m_s),
                   std::abs(after.b.velocity_W.x() - common_m_s)),
          after.momentum};
}

/// Two balls with crossing paths that collide; their velocities change along the contact normal.
Errors crossing(const Preset& preset) {
  const double radius_m = 0.05, start_m = 20.7;
  const Vec3 start_a(-start_m, 0, 0), start_b(0, 0, -start_m + radius_m);
  const Vec3 v_a(kSpeed_m_s, 0, 0), v_b(0, 0, kSpeed_m_s);
  const PairAfterFlight after = fly_pair(preset, W::moving(W::sphere(radius_m, start_a), v_a),
                                         W::moving(W::sphere(radius_m, start_b), v_b));
  // The time of impact is the smaller root of |start + t·v| = 2 r.
  const Vec3 start = start_b - start_a, v = v_b - v_a;
  const double along = start.dot(v), square = v.squaredNorm();
  const double meet_s =
      (-along -
       std::sqrt(along * along - square * (start.squaredNorm() - 4 * radius_m * radius_m))) /
      square;
  const Vec3 normal = (start + meet_s * v).normalized();
  const Vec3 change = 0.5 * v.dot(normal) * normal;  // equal masses, no restitution
  const Vec3 end_a = start_a + kFlight_s * v_a + (kFlight_s - meet_s) * change;
  return {(after.a.X_WB.position - end_a).norm(),
          std::max((after.a.velocity_W - (v_a + change)).norm(),
                   (after.b.velocity_W - (v_b - change)).norm()),
          after.momentum};
}

/// A fast thin plate that hits a ball, after which both move at a common velocity.
Errors plate_and_ball(const Preset& preset) {
  const double thick_m = 0.01, radius_m = 0.05, speed_m_s = 300;
  BodyDesc plate = W::moving(W::box(Vec3(thick_m, 1, 1), Vec3(-9.1, 0, 0)), Vec3(speed_m_s, 0, 0));
  plate.mass_kg = 10;
  const BodyDesc ball = W::sphere(radius_m, Vec3(1.3, 0, 0), 2000);
  const PairAfterFlight after = fly_pair(preset, plate, ball);
  const double common_m_s = speed_m_s * plate.mass_kg / (plate.mass_kg + ball.mass_kg);
  const double meet_s = (1.3 + 9.1 - radius_m - 0.5 * thick_m) / speed_m_s;
  const double end_m = 1.3 + common_m_s * (kFlight_s - meet_s);
  const double gap_m =
      after.b.X_WB.position.x() - after.a.X_WB.position.x() - radius_m - 0.5 * thick_m;
  return {std::max(std::abs(after.b.X_WB.position.x() - end_m), std::abs(gap_m)),
          std::abs(after.b.velocity_W.x() - common_m_s), after.momentum};
}

/// Measures the larger error of the preset's step and of a step of 1/30 s.
Measure worst_of(const std::function<Errors(const Preset&)>& errors, double Errors::*which) {
  return [=](const Preset& preset) {
    Preset coarse = preset;
    coarse.dt_s = 1.0 / 30;
    return std::max(errors(preset).*which, errors(coarse).*which);
  };
}

/// Collision of cubes with enough sweeps for the corners of a face to share the impulse evenly.
Errors cubes_with_32_sweeps(const Preset& preset) {
  Preset more_sweeps = preset;
  more_sweeps.sweeps = 32;
  return head_on(more_sweeps, false);
}
Errors balls_head_on(const Preset& preset) { return head_on(preset, true); }
Errors cubes_head_on(const Preset& preset) { return head_on(preset, false); }
Errors worst_momentum(const Preset& preset) {
  Errors worst;
  for (const auto& errors : {balls_head_on, cubes_head_on, crossing, plate_and_ball})
    worst.momentum = std::max(worst.momentum, errors(preset).momentum);
  return worst;
}

}  // namespace

Truths meeting_truths() {
  const char* source = "closed form";
  return {
      truth(15, "balls head-on at 1,000 m/s: place after", "m", source, 1e-3,
            worst_of(balls_head_on, &Errors::place_m), {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(15, "balls head-on at 1,000 m/s: speed after", "m/s", source, 1e-2,
            worst_of(balls_head_on, &Errors::speed_m_s), {0.001, 0.001, 0.001, 0.001}),
      truth(15, "cubes head-on at 1,000 m/s: place after", "m", source, 1e-3,
            worst_of(cubes_head_on, &Errors::place_m), {1.1, 1.1, 0.54, 0.001}),
      truth(15, "cubes head-on at 1,000 m/s: speed after", "m/s", source, 1e-2,
            worst_of(cubes_head_on, &Errors::speed_m_s), {16, 16, 7.5, 0.0014}),
      truth(15, "cubes head-on at 1,000 m/s, 32 sweeps: place after", "m", source, 1e-3,
            worst_of(cubes_with_32_sweeps, &Errors::place_m), {0.00035, 0.0001, 0.00035, 0.0001}),
      truth(15, "cubes head-on at 1,000 m/s, 32 sweeps: speed after", "m/s", source, 1e-2,
            worst_of(cubes_with_32_sweeps, &Errors::speed_m_s), {0.0075, 0.0014, 0.0075, 0.0014}),
      truth(15, "balls that cross at 500 m/s: place after", "m", source, 0.01,
            worst_of(crossing, &Errors::place_m), {0.0031, 0.0031, 0.0029, 0.0031}),
      truth(15, "balls that cross at 500 m/s: speed after", "m/s", source, 0.1,
            worst_of(crossing, &Errors::speed_m_s), {0.053, 0.053, 0.05, 0.053}),
      truth(15, "plate of 10 mm takes a ball at 300 m/s: place after", "m", source, 1e-3,
            worst_of(plate_and_ball, &Errors::place_m), {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(15, "plate of 10 mm takes a ball at 300 m/s: speed after", "m/s", source, 1e-2,
            worst_of(plate_and_ball, &Errors::speed_m_s), {0.001, 0.001, 0.001, 0.001}),
      truth(15, "all of these: momentum", "", "constant", 1e-6,
            worst_of(worst_momentum, &Errors::momentum), {9.4e-7, 3.1e-7, 9.1e-7, 6.2e-7}),
  };
}

}  // namespace sunder::truths
