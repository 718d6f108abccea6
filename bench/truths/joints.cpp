// Validation of joints: pendulums, tops and chains.
#include <algorithm>
#include <cmath>

#include "bench/truths/truth.h"
#include "engine/base/trigonometry.h"

namespace sunder::truths {
namespace {

using solver::joint_at;

double pendulum_period(const Preset& preset) {
  PresetWorld world(preset);
  const double side = 0.2, arm = 1, angle = 0.02;
  const SinCos a = sin_cos(angle);
  BodyDesc bob = W::box(Vec3(side, side, side), arm * Vec3(a.sin, -a.cos, 0));
  bob.X_WB.rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
  const BodyId id = world.add(bob);
  world.physics().join(joint_at(world, JointKind::kBall, {}, id, Vec3::Zero()));
  double time_s = 0, first_s = 0, last_s = 0, before = angle;
  int crossings = 0;
  world.watch(21, [&] {
    const double x = world.state(id).X_WB.position.x();
    time_s += preset.dt_s;
    if (before > 0 && x <= 0) {
      last_s = time_s - preset.dt_s * x / (x - before);
      if (crossings++ == 0) first_s = last_s;
    }
    before = x;
  });
  // Inertia about the pivot per mass is side²/6 + arm²; the amplitude adds angle²/16.
  const double truth =
      2 * kPi * std::sqrt((side * side / 6 + arm * arm) / (kG * arm)) * (1 + angle * angle / 16);
  return (last_s - first_s) / (crossings - 1) / truth - 1;
}

/// Largest deviation of energy, in m g l, of two rods of 1 m that fall from the horizontal.
double double_pendulum(const Preset& preset) {
  PresetWorld world(preset);
  const BodyDesc rod = W::box(Vec3(1, 0.1, 0.1), Vec3(0.5, 0, 0));
  BodyDesc second = rod;
  second.X_WB.position.x() += 1;
  const BodyId a = world.add(rod), b = world.add(second);
  world.physics().join(joint_at(world, JointKind::kHinge, {}, a, Vec3::Zero()));
  world.physics().join(joint_at(world, JointKind::kHinge, a, b, Vec3(1, 0, 0)));
  const auto energy = [&] { return world.kinetic_energy() + world.potential_energy(kG); };
  const double first_J = energy();
  double worst_J = 0;
  world.watch(20, [&] { worst_J = std::max(worst_J, std::abs(energy() - first_J)); });
  return worst_J / (rod.mass_kg * kG * 1);
}

/// Errors of two boxes in a fixed joint that rotate freely at 20 rad/s for 10 s.
struct PairErrors {
  double energy = 0, spin = 0;
};
PairErrors fixed_pair(const Preset& preset) {
  PresetWorld world(preset, Vec3::Zero());
  const Vec3 spin(1, 20, 3), at_a(-0.5, 0, 0), at_b(0.5, 0.1, 0);
  const BodyId a = world.add(W::moving(W::box(Vec3(0.9, 0.4, 0.3), at_a), spin.cross(at_a), spin));
  const BodyId b =
      world.add(W::moving(W::box(Vec3(0.8, 0.3, 0.5), at_b, 2000), spin.cross(at_b), spin));
  world.physics().join(joint_at(world, JointKind::kFixed, a, b, Vec3::Zero()));
  const double first_J = world.kinetic_energy();
  const Vec3 first = world.angular_momentum();
  world.run(10);
  return {world.kinetic_energy() / first_J - 1,
          (world.angular_momentum() - first).norm() / first.norm()};
}

/// A leaning spinning top: a plate of 0.4 m whose centre is 0.3 m above the pivot. `across` and
/// `along` are its moments of inertia about the pivot.
struct Top {
  Top(const Preset& preset, double lean_rad, double spin_rad_s) : world(preset) {
    const Quat turn(Eigen::AngleAxisd(lean_rad, Vec3::UnitZ()));
    const Vec3 axis = turn * Vec3::UnitY();
    desc = W::box(Vec3(0.4, 0.1, 0.4), kArm_m * axis);
    desc.X_WB.rotation = turn;
    across = desc.inertia_B(0, 0) + desc.mass_kg * kArm_m * kArm_m;
    along = desc.inertia_B(1, 1);
    moment = desc.mass_kg * kG * kArm_m;
    // Steady precession is the smaller root Ω of across Ω² cos θ − along ω Ω + m g l = 0.
    const double cos = axis.y(), axial_momentum = along * spin_rad_s;
    const double root = axial_momentum * axial_momentum - 4 * across * cos * moment;
    precession_rad_s = root > 0 ? (axial_momentum - std::sqrt(root)) / (2 * across * cos) : 0;
    desc.angular_velocity_W =
        precession_rad_s * Vec3::UnitY() + (spin_rad_s - precession_rad_s * cos) * axis;
    desc.velocity_W = desc.angular_velocity_W.cross(desc.X_WB.position);
    id = world.add(desc);
    world.physics().join(joint_at(world, JointKind::kBall, {}, id, Vec3::Zero()));
  }
  Vec3 center() const { return world.state(id).X_WB.position; }

  static constexpr double kArm_m = 0.3;
  PresetWorld world;
  BodyDesc desc;
  BodyId id;
  double across = 0, along = 0, moment = 0, precession_rad_s = 0;
};

double precession(const Preset& preset) {
  Top top(preset, 0.3, 60);
  double angle = 0, time_s = 0;
  Vec3 last = top.center();
  top.world.watch(4, [&] {
    const Vec3 now = top.center();
    angle += std::atan2(now.x() * last.z() - now.z() * last.x(),
                        last.x() * now.x() + last.z() * now.z());
    last = now;
    time_s += preset.dt_s;
  });
  return angle / time_s / top.precession_rad_s - 1;
}

/// Relative error of the least spin at which an almost upright top sleeps, that is, stays upright.
double sleeping_top(const Preset& preset) {
  const auto sleeps = [&](double spin_rad_s) {
    Top top(preset, 2e-3, spin_rad_s);
    double lowest_m = Top::kArm_m;
    top.world.watch(8, [&] { lowest_m = std::min(lowest_m, top.center().y()); });
    return lowest_m > Top::kArm_m * std::cos(0.2);
  };
  const Top any(preset, 0, 100);
  const double truth = 2 * std::sqrt(any.moment * any.across) / any.along;
  return threshold(0.94, 1.06, 6, [&](double part) { return sleeps(part * truth); }) - 1;
}

/// Largest sum of joint separations in five seconds, relative to the length, of a chain of twenty
/// links of 0.2 m in the direction `along` with a ball that is `ratio` times as heavy as a link.
double chain_stretch(const Preset& preset, double ratio, const Vec3& along) {
  PresetWorld world(preset);
  constexpr double kLink_m = 0.2, kRadius_m = 0.3;
  const Vec3 across = Vec3::Constant(0.05);
  const BodyDesc link = W::box(across + (kLink_m - 0.05) * along.cwiseAbs(), Vec3::Zero());
  const double volume_m3 = 4.0 / 3 * kPi * std::pow(kRadius_m, 3);
  std::vector<JointDesc> joints;
  BodyId last;
  for (int i = 0; i <= 20; ++i) {
    const Vec3 at_W = i * kLink_m * along;
    BodyDesc desc = link;
    desc.X_WB.position = at_W + 0.5 * kLink_m * along;
    if (i == 20)
      desc = W::sphere(kRadius_m, at_W + kRadius_m * along, ratio * link.mass_kg / volume_m3);
    const BodyId next = world.add(desc);
    joints.push_back(joint_at(world, JointKind::kBall, last, next, at_W));
    world.physics().join(joints.back());
    last = next;
  }
  double worst_m = 0;
  world.watch(5, [&] {
    double sum_m = 0;
    for (const JointDesc& joint : joints) {
      const Vec3 a =
          joint.a.none() ? joint.anchor_a_R : world.state(joint.a).X_WB * joint.anchor_a_R;
      sum_m += (world.state(joint.b).X_WB * joint.anchor_b_R - a).norm();
    }
    worst_m = std::max(worst_m, sum_m);
  });
  return worst_m / (20 * kLink_m);
}
Measure stretch(double ratio, const Vec3& along) {
  return [=](const Preset& p) { return chain_stretch(p, ratio, along); };
}

}  // namespace

Truths joint_truths() {
  return {
      truth(7, "heavy top, 60 rad/s, leaning .3: precession", "", "steady precession, slow root",
            0.01, precession, {0.0043, 0.001, 0.001, 0.001}),
      truth(7, "sleeping top: least spin", "", "ω₃² = 4 m g l I₁/I₃²", 0.01, sleeping_top,
            {0.0015, 0.0071, 0.0071, 0.0071}),
      truth(29, "two boxes in a fixed joint, 20 rad/s, 10 s: E", "", "constant", 1e-3,
            [](const Preset& p) { return fixed_pair(p).energy; },
            {0.0014, 0.00035, 0.00041, 0.0001}),
      truth(29, "two boxes in a fixed joint, 20 rad/s, 10 s: L", "", "constant", 1e-6,
            [](const Preset& p) { return fixed_pair(p).spin; },
            {5.7e-05, 3.2e-05, 7.4e-05, 0.00011}),
      truth(30, "pendulum: period", "", "2π √(I/m g l), amplitude .02", 1e-3, pendulum_period,
            {0.0001, 0.0001, 0.0001, 0.0001}),
      truth(30, "double pendulum, 20 s: E, of m g l", "", "constant", 0.005, double_pendulum,
            {0.0033, 0.005, 0.00061, 0.0005}),
      truth(31, "20 links that swing a ball as heavy as one: stretch", "", "inextensible", 0.01,
            stretch(1, Vec3::UnitX()), {0.0095, 0.0066, 0.0025, 0.001}),
      truth(31, "20 links that swing a ball of 100 : 1: stretch", "", "inextensible", 0.01,
            stretch(100, Vec3::UnitX()), {0.001, 0.001, 0.001, 0.001}),
      truth(31, "20 links that swing a ball of 1,000 : 1: stretch", "", "inextensible", 0.01,
            stretch(1000, Vec3::UnitX()), {0.001, 0.001, 0.001, 0.001}),
      truth(31, "20 links that hold a ball of 1,000 : 1: stretch", "", "inextensible", 0.01,
            stretch(1000, -Vec3::UnitY()), {0.001, 0.001, 0.001, 0.001}),
  };
}

}  // namespace sunder::truths
