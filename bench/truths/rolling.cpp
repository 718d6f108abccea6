// Validation of rolling, rocking and toppling.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"

namespace sunder::truths {
namespace {

/// A ball with a radius of 0.2 m on a slope; gravity is rotated instead of the ground.
struct Roller {
  Roller(const Preset& preset, double slope_rad, double friction, const Vec3& velocity_W,
         double spin_rad_s, double rolling)
      : world(preset, gravity(slope_rad)) {
    world.add(W::with_friction(W::ground(), friction));
    BodyDesc ball = W::with_friction(W::sphere(0.2, Vec3(0, 0.2, 0)), friction);
    ball.shapes[0].rolling = rolling;
    ball.velocity_W = velocity_W;
    ball.angular_velocity_W = Vec3(0, 0, -spin_rad_s);
    id = world.add(ball);
  }
  static Vec3 gravity(double slope_rad) {
    const SinCos a = sin_cos(slope_rad);
    return kG * Vec3(a.sin, -a.cos, 0);
  }
  double distance_m() const { return world.state(id).X_WB.position.x(); }
  double speed_m_s() const { return world.state(id).velocity_W.x(); }

  PresetWorld world;
  BodyId id;
};

/// The ball rolls without sliding after 2 v / 7 mu g = 0.68 s.
double slip_to_roll(const Preset& preset) {
  Roller ball(preset, 0, 0.3, Vec3(7, 0, 0), 0, 0);
  ball.world.run(1.5);
  return ball.speed_m_s() / 5 - 1;
}

double rolls_down(const Preset& preset) {
  Roller ball(preset, 0.2, 0.8, Vec3::Zero(), 0, 0);
  ball.world.run(2);
  return ball.speed_m_s() / (2 * 5.0 / 7 * kG * sin_cos(0.2).sin) - 1;
}

/// The energy 7/10 m v² is spent against the force mu_r m g, equivalent to the resisting torque.
double rolling_distance(const Preset& preset) {
  const double rolling = 0.05, speed_m_s = 2;
  Roller ball(preset, 0, 0.8, Vec3(speed_m_s, 0, 0), speed_m_s / 0.2, rolling);
  ball.world.run(7);
  return ball.distance_m() * rolling * kG / (0.7 * speed_m_s * speed_m_s) - 1;
}

/// Returns the distance in m that a ball rolls in two seconds on a slope of `slope_factor` times
/// the angle that its rolling resistance holds.
double rolled_m(const Preset& preset, double slope_factor) {
  const double rolling = 0.1;
  Roller ball(preset, slope_factor * std::atan(rolling), 0.8, Vec3::Zero(), 0, rolling);
  ball.world.run(0.5);
  const double start_m = ball.distance_m();
  ball.world.run(2);
  return ball.distance_m() - start_m;
}

/// Motion of a free-standing block, h = 1 m and b = 0.2 m, from half of its critical tilt.
struct Rocking {
  double quarter_s = 0;  ///< Time until the block is first upright.
  double tilt_rad = 0;   ///< Largest tilt to the other side.
};
constexpr double kAlpha_rad = 0.19739555984988;  // atan(b/h)
constexpr double kTilt_rad = 0.5 * kAlpha_rad;
const double kP2 = 0.75 * kG / (0.5 * std::sqrt(1 + 0.04));  // 3 g / 4 R

Rocking rock(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 1));
  const Quat turn(Eigen::AngleAxisd(-kTilt_rad, Vec3::UnitZ()));
  const Vec3 foot(0.1, 0, 0);  // corner that it rotates about
  BodyDesc block = W::with_friction(W::box(Vec3(0.2, 1, 0.4), foot + turn * Vec3(-0.1, 0.5, 0)), 1);
  block.X_WB.rotation = turn;
  const BodyId id = world.add(block);
  Rocking rocking;
  double time_s = 0, before_rad = kTilt_rad;
  world.watch(1.2, [&] {
    const Vec3 up = world.state(id).X_WB.rotation * Vec3::UnitY();
    const double tilt_rad = std::asin(up.x());
    time_s += preset.dt_s;
    if (rocking.quarter_s == 0 && tilt_rad <= 0)
      rocking.quarter_s = time_s + preset.dt_s * tilt_rad / (before_rad - tilt_rad);
    rocking.tilt_rad = std::max(rocking.tilt_rad, -tilt_rad);
    before_rad = tilt_rad;
  });
  return rocking;
}

/// Integrates θ'' = −p² sin(α − θ) from rest; Housner's acosh is for small angles only.
double rocking_quarter_s() {
  double tilt_rad = kTilt_rad, speed = 0, time_s = 0;
  const double dt_s = 1e-5;
  for (; tilt_rad > 0; time_s += dt_s) {
    speed -= dt_s * kP2 * std::sin(kAlpha_rad - tilt_rad);
    tilt_rad += dt_s * speed;
  }
  return time_s;
}

/// Relative error of ω⁺/ω⁻ in the impact, from the potential energies of both tilts.
double rocking_ratio(const Preset& preset) {
  const auto energy = [](double tilt_rad) {
    return std::cos(kAlpha_rad - tilt_rad) - std::cos(kAlpha_rad);
  };
  const double ratio = std::sqrt(energy(rock(preset).tilt_rad) / energy(kTilt_rad));
  const double sin = sin_cos(kAlpha_rad).sin;
  return ratio / (1 - 1.5 * sin * sin) - 1;
}

/// A prism of 16 edges, radius 0.5 m, that rolls down 20° without sliding, slowly enough not to
/// lift off, and the distance that it covers in kRollTime_s.
constexpr int kEdges = 16;
constexpr double kSlope_rad = 20 * kPi / 180, kRollTime_s = 0.9;

double prism_distance_m(const Preset& preset) {
  PresetWorld world(preset, Roller::gravity(kSlope_rad));
  world.add(W::with_friction(W::ground(), 1));
  std::vector<Vec3> corners;
  for (int i = 0; i < kEdges; ++i) {
    const SinCos a = sin_cos(2 * kPi * (i + 0.5) / kEdges);
    for (const double z : {-0.2, 0.2}) corners.emplace_back(0.5 * a.sin, 0.5 * a.cos, z);
  }
  const double apothem = 0.5 * std::cos(kPi / kEdges);
  const BodyId id =
      world.add(W::with_friction(W::hull(make_hull(corners), Vec3(0, apothem, 0)), 1));
  world.run(kRollTime_s);
  return world.state(id).X_WB.position.x();
}

/// Distance of the same motion as a sequence of pivots; an impact leaves (I + R² cos 2π/n) / (I +
/// R²) of the angular velocity.
double pivoting_distance_m() {
  const double R = 0.5, half = kPi / kEdges, side = 2 * R * std::sin(half);
  // Inertia of a regular polygon: m R²/2 (1 − 2/3 sin² π/n).
  const double inertia = 0.5 * R * R * (1 - 2.0 / 3 * std::sin(half) * std::sin(half));
  const double spin_ratio = (inertia + R * R * std::cos(2 * half)) / (inertia + R * R);
  const double q2 = kG * R / (inertia + R * R), dt_s = 1e-5;
  double lean_rad = kSlope_rad - half, spin = 0, pivot_m = R * std::sin(half);
  for (double t = 0; t < kRollTime_s; t += dt_s) {
    spin += dt_s * q2 * std::sin(lean_rad);
    lean_rad += dt_s * spin;
    if (lean_rad >= kSlope_rad + half) lean_rad -= 2 * half, spin *= spin_ratio, pivot_m += side;
  }
  return pivot_m + R * std::sin(lean_rad - kSlope_rad);
}

/// Slip of the foot and angular velocity at 55° of a column of H/b = 5 that topples from its
/// balance.
struct Toppling {
  double foot_m = 0, spin_rad_s = 0;
};
constexpr double kLean_rad = kAlpha_rad + 0.02;  // at the start

Toppling topple(const Preset& preset) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 1));
  const auto at_lean = [](double lean_rad) {
    return Quat(Eigen::AngleAxisd(-lean_rad, Vec3::UnitZ()));
  };
  const Vec3 corner_B(0.1, -0.5, 0);
  BodyDesc column =
      W::with_friction(W::box(Vec3(0.2, 1, 0.4), at_lean(kLean_rad) * Vec3(-corner_B)), 1);
  column.X_WB.rotation = at_lean(kLean_rad);
  const BodyId id = world.add(column);
  Toppling toppling;
  double before_rad = kLean_rad, before_spin = 0;
  world.watch(4, [&] {
    const BodyState s = world.state(id);
    const Vec3 up = s.X_WB.rotation * Vec3::UnitY();
    const double lean_rad = std::atan2(up.x(), up.y()), spin = -s.angular_velocity_W.z();
    if (toppling.spin_rad_s > 0) return;
    const double end_rad = 55 * kPi / 180;
    if (lean_rad < end_rad) {
      toppling.foot_m = std::max(toppling.foot_m, std::abs((s.X_WB * corner_B).x()));
    } else {
      const double part = (end_rad - before_rad) / (lean_rad - before_rad);
      toppling.spin_rad_s = before_spin + part * (spin - before_spin);
    }
    before_rad = lean_rad, before_spin = spin;
  });
  return toppling;
}

/// Theory: I ω²/2 = m g R (cos(lean − α) at the start − at 55°) about the corner.
double toppling_spin(const Preset& preset) {
  const double truth = std::sqrt(
      2 * kP2 * (std::cos(kLean_rad - kAlpha_rad) - std::cos(55 * kPi / 180 - kAlpha_rad)));
  return topple(preset).spin_rad_s / truth - 1;
}

}  // namespace

Truths rolling_truths() {
  return {
      truth(5, "sliding ball that comes to roll: speed", "", "5/7 v", 1e-3, slip_to_roll,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(5, "ball rolling down a slope: speed", "", "5/7 g sin θ t", 1e-3, rolls_down,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(5, "rolling resistance: way to rest", "", "7/10 v² over μ_r g", 0.01, rolling_distance,
            {0.001, 0.001, 0.001, 0.001}),
      truth(5, "ball on 0.98 of the slope that its resistance holds: creep in 2 s", "mm", "statics",
            0.2, [](const Preset& p) { return 1e3 * rolled_m(p, 0.98); }, {0.37, 0.43, 0.2, 0.19}),
      truth(5, "ball on 1.02 of it: way in 2 s", "", "5/7 g (sin θ − μ_r cos θ) t²/2", 0.02,
            [](const Preset& p) {
              const SinCos a = sin_cos(1.02 * std::atan(0.1));
              const double accel = 5.0 / 7 * kG * (a.sin - 0.1 * a.cos);
              return rolled_m(p, 1.02) / (accel * (0.5 * 2 + 0.5 * 4)) - 1;
            },
            {0.041, 0.042, 0.02, 0.0027}),
      truth(13, "rocking block: time to the first impact", "", "Housner 1963, exact angles", 0.01,
            [](const Preset& p) { return rock(p).quarter_s / rocking_quarter_s() - 1; },
            {0.001, 0.0027, 0.001, 0.001}),
      truth(13, "rocking block: spin that an impact leaves", "", "1 − 1.5 sin²α, Housner 1963",
            0.02, rocking_ratio, {0.063, 0.046, 0.029, 0.015}),
      truth(33, "prism of 16 edges down 20°: way", "", "pivoting, McGeer 1990", 0.01,
            [](const Preset& p) { return prism_distance_m(p) / pivoting_distance_m() - 1; },
            {0.036, 0.015, 0.021, 0.0097}),
      truth(33, "toppling column of 1 to 5: its foot slips", "mm", "pivoting", 1,
            [](const Preset& p) { return 1e3 * topple(p).foot_m; }, {3.9, 2, 2.3, 0.54}),
      truth(33, "toppling column of 1 to 5: spin at 55°", "", "energy", 0.01, toppling_spin,
            {0.01, 0.01, 0.0065, 0.0034}),
  };
}

}  // namespace sunder::truths
