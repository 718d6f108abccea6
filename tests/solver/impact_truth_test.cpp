// Impacts, spin and joints against closed forms at every preset (notes: truths 4, 6, 15).
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "bench/truths/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

/// How long a ball bounces that is let go 1 m above the ground, until it no longer leaves it.
double time_of_bounces(double restitution, const Preset& preset) {
  RigidWorld world(awake(preset));
  world.add(W::with_friction(W::ground(), 0.5, restitution));
  const BodyId ball =
      world.add(W::with_friction(W::sphere(0.1, Vec3(0, 1.1, 0)), 0.5, restitution));
  double last_s = 0;
  const double end_s = 6;
  for (int i = 1; i * preset.dt_s < end_s; ++i) {
    world.step(preset.dt_s, preset.substeps);
    const BodyState s = world.state(ball);
    if (s.X_WB.position.y() > 0.1005 || std::abs(s.velocity_W.y()) > 0.05) last_s = i * preset.dt_s;
  }
  return last_s;
}

TEST(ImpactTruth, ABallBouncesForAsLongAsTheGeometricSeries) {
  const double e = 0.5, truth = std::sqrt(2 / kG) * (1 + e) / (1 - e);
  const double error = at_each_preset("bounces until rest, error of time (mark .01)",
                                      [&](auto& p) { return time_of_bounces(e, p) / truth - 1; });
  EXPECT_LT(std::abs(error), 0.05);
}

TEST(ImpactTruth, ABallReboundsToTheSquareOfItsRestitution) {
  const double e = 0.8;
  const double error = at_each_preset("apex of a bounce, error (mark .01)", [&](auto& p) {
    RigidWorld world(awake(p));
    world.add(W::with_friction(W::ground(), 0.5, e));
    const BodyId ball = world.add(W::with_friction(W::sphere(0.1, Vec3(0, 1.1, 0)), 0.5, e));
    double apex = 0;
    bool rising = false;
    for (int i = 0; i * p.dt_s < 2; ++i) {
      world.step(p.dt_s, p.substeps);
      const BodyState s = world.state(ball);
      rising = rising || s.velocity_W.y() > 1;
      if (rising && s.velocity_W.y() < 0) break;
      if (rising) apex = std::max(apex, s.X_WB.position.y() - 0.1);
    }
    return apex / (e * e) - 1;
  });
  EXPECT_LT(std::abs(error), 0.01);
}

TEST(ImpactTruth, AFreeSpinnerKeepsEnergyAndAngularMomentumForAMinute) {
  double momentum_error = 0;
  const double error = at_each_preset("free spinner 60 s, error of E (mark 1e-3)", [&](auto& p) {
    RigidWorld world(awake(p, Vec3::Zero()));
    BodyDesc desc = W::box(Vec3(1, 0.6, 0.2), Vec3::Zero());
    desc.angular_velocity_W = Vec3(0.01, 10, 0.01);  // about the middle axis: it tumbles over
    world.add(desc);
    const double energy = world.kinetic_energy();
    const Vec3 momentum = world.angular_momentum();
    world.run(60, p.dt_s, p.substeps);
    momentum_error =
        std::max(momentum_error, (world.angular_momentum() - momentum).norm() / momentum.norm());
    return world.kinetic_energy() / energy - 1;
  });
  std::printf("free spinner 60 s, largest error of L %.1e (mark 1e-6)\n", momentum_error);
  EXPECT_LT(std::abs(error), 1e-3);
  EXPECT_LT(momentum_error, 1e-6);
}

TEST(ImpactTruth, ATwoBodyImpactLosesTheEnergyOfItsRestitution) {
  for (const double e : {0.0, 0.5, 1.0}) {
    double momentum_error = 0;
    const double error =
        at_each_preset("two-body impact, error of lost E (mark .005)", [&](auto& p) {
          RigidWorld world(awake(p, Vec3::Zero()));
          BodyDesc a = W::with_friction(W::sphere(0.1, Vec3(-1, 0, 0)), 0, e);
          a.velocity_W = Vec3(5, 0, 0);
          BodyDesc b = W::with_friction(W::sphere(0.15, Vec3(0.1, 0, 0)), 0, e);
          b.velocity_W = Vec3(-1, 0, 0);
          world.add(a), world.add(b);
          const double before = world.kinetic_energy();
          const Vec3 momentum = world.momentum();
          world.run(0.5, p.dt_s, p.substeps);
          momentum_error = std::max(
              momentum_error, (world.momentum() - momentum).norm() / (5 * a.mass_kg + b.mass_kg));
          const double reduced = a.mass_kg * b.mass_kg / (a.mass_kg + b.mass_kg);
          return (before - world.kinetic_energy() - 0.5 * reduced * (1 - e * e) * 36) / before;
        });
    EXPECT_LT(std::abs(error), 0.005) << "e " << e;
    EXPECT_LT(momentum_error, 1e-6);
  }
}

TEST(ImpactTruth, ATurningBlockStopsByTheTwistOfItsPatch) {
  // A square patch of four points at radius r: the torque of friction is mu m g r.
  const double mu = 0.4, speed = 3, side = 1, height = 0.2;
  const double error = at_each_preset("twist friction, error of the turn to rest", [&](auto& p) {
    RigidWorld world(awake(p));
    world.add(W::with_friction(W::ground(), mu));
    const BodyDesc desc =
        W::with_friction(W::box(Vec3(side, height, side), Vec3(0, height / 2, 0)), mu);
    const BodyId id = world.add(desc);
    world.run(0.5, p.dt_s, p.substeps);  // settles into the ground
    const double inertia = desc.inertia_B(1, 1), r = std::sqrt(0.5) * side;
    const Vec3 kick(0, 0, 0.5 * speed * inertia / (side / 2));
    world.physics().apply_impulse(id, kick, Vec3(-side / 2, 0, 0) + world.state(id).X_WB.position);
    world.physics().apply_impulse(id, -kick, Vec3(side / 2, 0, 0) + world.state(id).X_WB.position);
    const Quat before = world.state(id).X_WB.rotation;
    world.run(2, p.dt_s, p.substeps);
    const Quat turn = before.conjugate() * world.state(id).X_WB.rotation;
    const double angle = 2 * std::atan2(std::abs(turn.y()), std::abs(turn.w()));
    const double truth = 0.5 * inertia * speed * speed / (mu * desc.mass_kg * kG * r);
    return angle / truth - 1;
  });
  EXPECT_LT(std::abs(error), 0.02);
}

/// A ball of radius 0.2 m with resistance to rolling on a slope; level if the slope is 0.
struct Roller {
  Roller(double slope_rad, double rolling, double speed_m_s) : world(awake(down(slope_rad))) {
    world.add(W::with_friction(W::ground(), 0.8));
    BodyDesc ball = W::with_friction(W::sphere(0.2, Vec3(0, 0.2, 0)), 0.8);
    ball.shapes[0].rolling = rolling;
    ball.velocity_W = Vec3(speed_m_s, 0, 0);
    ball.angular_velocity_W = Vec3(0, 0, -speed_m_s / 0.2);
    id = world.add(ball);
  }
  static Vec3 down(double slope_rad) {
    const SinCos a = sin_cos(slope_rad);
    return kG * Vec3(a.sin, -a.cos, 0);
  }
  double way() const { return world.state(id).X_WB.position.x(); }

  RigidWorld world;
  BodyId id;
};

TEST(ImpactTruth, ARollingBallStopsAfterItsRollingDistance) {
  // Energy 7/10 m v² against the force mu_r m g that its torque amounts to.
  const double rolling = 0.05, speed = 2, truth = 0.7 * speed * speed / (rolling * kG);
  const double error =
      at_each_preset("rolling resistance, error of the way (mark .01)", [&](auto& p) {
        Roller roller(0, rolling, speed);
        roller.world.run(7, p.dt_s, p.substeps);
        return roller.way() / truth - 1;
      });
  EXPECT_LT(std::abs(error), 0.01);
}

TEST(ImpactTruth, ABallHoldsOnASlopeUpToItsRollingResistance) {
  const double rolling = 0.1, steepest = 0.0996686525;  // atan(0.1)
  const double creep =
      at_each_preset("ball on 0.98 of its steepest slope, creep in 2 s, m", [&](auto& p) {
        Roller roller(0.98 * steepest, rolling, 0);
        roller.world.run(0.5, p.dt_s, p.substeps);
        const double start = roller.way();
        roller.world.run(2, p.dt_s, p.substeps);
        return roller.way() - start;
      });
  EXPECT_LT(std::abs(creep), 2e-4);
  Roller roller(1.02 * steepest, rolling, 0);
  roller.world.run(2, 1.0 / 120, 8);
  EXPECT_GT(roller.way(), 0.01);
}

}  // namespace
}  // namespace sunder::solver
