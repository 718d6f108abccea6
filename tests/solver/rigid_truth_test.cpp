// Motion against closed forms (notes: truths 1, 2, 8). Impacts and spin: impact_truth_test.cpp.
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "bench/truths/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81;

TEST(RigidTruth, FreeFallFollowsTheParabolaAtAnyStep) {
  for (const double dt : {1.0 / 30, 1.0 / 120, 1.0 / 500}) {
    RigidWorld world;
    BodyDesc desc = W::box(Vec3(1, 1, 1), Vec3(0, 100, 0));
    desc.velocity_W = Vec3(3, 5, 0);
    const BodyId body = world.add(desc);
    world.run(2, dt, 2);
    const BodyState end = world.state(body);
    EXPECT_NEAR(end.X_WB.position.x(), 6, 1e-9);
    EXPECT_NEAR(end.X_WB.position.y(), 100 + 5 * 2 - 0.5 * kG * 4, 1e-9);
    EXPECT_NEAR(end.velocity_W.y(), 5 - kG * 2, 1e-9);
  }
}

/// Angles in degrees; the way slid in two seconds.
double slide_on_incline(double angle_deg, double friction) {
  const SinCos a = sin_cos(angle_deg * 3.14159265358979 / 180);
  RigidOptions options;
  options.gravity_W = kG * Vec3(a.sin, -a.cos, 0);  // the incline is level, gravity leans
  options.sleeping = false;
  RigidWorld world(options);
  world.add(W::with_friction(W::ground(), friction));
  const BodyId body =
      world.add(W::with_friction(W::box(Vec3(1, 0.4, 1), Vec3(0, 0.2, 0)), friction));
  world.run(0.5, 1.0 / 240, 4);  // settles into the ground
  const double start = world.state(body).X_WB.position.x();
  world.run(2, 1.0 / 240, 4);
  return world.state(body).X_WB.position.x() - start;
}

TEST(RigidTruth, WhatTumblesKeepsItsAngularMomentumHoweverLittleItTurnsInAStep) {
  for (const double rate : {60.0, 240.0, 1000.0}) {
    for (const double spin : {0.5, 5.0}) {
      RigidOptions options;
      options.gravity_W.setZero();
      RigidWorld world(options);
      BodyDesc slab = W::box(Vec3(1, 0.2, 0.5), Vec3::Zero());
      slab.angular_velocity_W = spin * Vec3(1, 2, 0.5).normalized();
      world.add(slab);
      const Vec3 before = world.angular_momentum();
      const double before_J = world.kinetic_energy();
      world.run(4, 1 / rate, 4);
      const double error = (world.angular_momentum() - before).norm() / before.norm();
      std::printf("tumbles at %g rad/s, steps of 1/%g s: off by %.1e of its spin\n", spin, rate,
                  error);
      EXPECT_LT(error, 1e-6);
      EXPECT_NEAR(world.kinetic_energy(), before_J, 1e-6 * before_J);
    }
  }
}

TEST(RigidTruth, ABlockSlidesOnAnInclineOnlyBeyondTheFrictionAngle) {
  const double friction = 0.5, threshold_deg = 26.565051;
  EXPECT_LT(std::abs(slide_on_incline(threshold_deg - 0.1, friction)), 2e-4);
  EXPECT_GT(slide_on_incline(threshold_deg + 0.1, friction), 5e-3);
}

TEST(RigidTruth, ASlidingBlockStopsAfterItsBrakingDistance) {
  RigidWorld world;
  const double friction = 0.4, speed = 3;
  world.add(W::with_friction(W::ground(), friction));
  const BodyId body =
      world.add(W::with_friction(W::box(Vec3(1, 0.2, 1), Vec3(0, 0.1, 0)), friction));
  world.run(0.25, 1.0 / 240, 4);
  const double mass = 200;
  world.physics().apply_impulse(body, Vec3(speed * mass, 0, 0), world.state(body).X_WB.position);
  world.run(2, 1.0 / 240, 4);
  const double way = world.state(body).X_WB.position.x(),
               truth = speed * speed / (2 * friction * kG);
  std::printf("braking distance %.5f m, truth %.5f m\n", way, truth);
  EXPECT_NEAR(way / truth, 1, 0.005);
}

void expect_stack_rests(double dt, int substeps) {
  RigidOptions options;
  options.sleeping = false;
  RigidWorld world(options);
  world.add(W::ground());
  for (int i = 0; i < 10; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(0, 0.5 + i, 0)));
  world.run(10, dt, substeps);
  for (std::size_t i = 1; i <= 10; ++i) {
    const BodyState s = world.state(world.id(i));
    const Vec3 home(0, static_cast<double>(i) - 0.5, 0);
    EXPECT_LT((s.X_WB.position - home).norm(), 0.02) << "box " << i;
    EXPECT_LT(s.velocity_W.norm(), 5e-3);
  }
  const BodyState top = world.state(world.id(10));
  std::printf("stack of 10, dt 1/%.0f x %d: top sinks %.3f mm, drifts %.4f mm, speed %.1e m/s\n",
              1 / dt, substeps, 1e3 * (9.5 - top.X_WB.position.y()),
              1e3 * std::hypot(top.X_WB.position.x(), top.X_WB.position.z()),
              top.velocity_W.norm());
}

TEST(RigidTruth, AStackOfTenRestsForTenSeconds) {
  expect_stack_rests(1.0 / 60, 8);
  expect_stack_rests(1.0 / 120, 4);
}

TEST(RigidTruth, APyramidComesToRest) {
  RigidOptions options;
  options.sleeping = false;
  RigidWorld world(options);
  world.add(W::ground());
  constexpr int kBase = 20;
  for (int row = 0; row < kBase; ++row)
    for (int i = 0; i < kBase - row; ++i)
      world.add(W::box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0), 2000));
  world.run(10, 1.0 / 60, 4);
  double square = 0;
  for (std::size_t i = 1; i < world.size(); ++i)
    square += world.state(world.id(i)).velocity_W.squaredNorm();
  const double rms = std::sqrt(square / static_cast<double>(world.size() - 1));
  std::printf("pyramid of 210: rms speed %.1e m/s\n", rms);
  EXPECT_LT(rms, 2e-3);
}

}  // namespace
}  // namespace sunder::solver
