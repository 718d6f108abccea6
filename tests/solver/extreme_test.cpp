// Tests of extreme input: nothing is NaN, energy is not created, and work is bounded. Energy is
// tested at every preset in bench/truths/energy.cpp. Each test prints its measurements.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kG = 9.81;

/// Returns the solver's maximum speed of overlap correction for cubes of this side.
double correction_speed_m_s(double side_m, double gravity_m_s2) {
  return 4 * std::sqrt(gravity_m_s2 * 0.5 * side_m);
}

RigidOptions awake(bool gravity = true) {
  RigidOptions options;
  options.sleeping = false;
  if (!gravity) options.gravity_W.setZero();
  return options;
}

double potential_energy(const RigidWorld& world, const std::vector<double>& masses) {
  double sum = 0;
  for (std::size_t i = 0; i < masses.size(); ++i)
    sum += masses[i] * kG * world.state(world.id(i)).X_WB.position.y();
  return sum;
}

double max_speed(const RigidWorld& world) {
  double most = 0;
  for (std::size_t i = 0; i < world.size(); ++i)
    most = std::max(most, world.state(world.id(i)).velocity_W.norm());
  return most;
}

bool finite(const RigidWorld& world) {
  for (std::size_t i = 0; i < world.size(); ++i) {
    const BodyState s = world.state(world.id(i));
    if (!s.X_WB.position.allFinite() || !s.X_WB.rotation.coeffs().allFinite() ||
        !s.velocity_W.allFinite() || !s.angular_velocity_W.allFinite())
      return false;
  }
  return true;
}

TEST(Extremes, InvalidBodiesAreRefusedAndTheWorldIsUnchanged) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const BodyDesc good = W::box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
  ConvexPolyhedron broken = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  broken.vertices[3].x() = kNan;
  ConvexPolyhedron flat = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  for (Vec3& vertex : flat.vertices) vertex.y() = 0;
  const ConvexPolyhedron none;
  const std::vector<std::function<void(BodyDesc&)>> faults = {
      [&](BodyDesc& d) { d.X_WB.position.x() = kNan; },
      [&](BodyDesc& d) { d.X_WB.position.y() = kInf; },
      [&](BodyDesc& d) { d.X_WB.rotation = Quat(0, 0, 0, 0); },
      [&](BodyDesc& d) { d.velocity_W.z() = kInf; },
      [&](BodyDesc& d) { d.angular_velocity_W.z() = kNan; },
      [&](BodyDesc& d) { d.com_R.z() = kNan; },
      [&](BodyDesc& d) { d.mass_kg = 0; },
      [&](BodyDesc& d) { d.mass_kg = -1; },
      [&](BodyDesc& d) { d.mass_kg = kNan; },
      [&](BodyDesc& d) { d.mass_kg = kInf; },
      [&](BodyDesc& d) { d.inertia_B.setZero(); },
      [&](BodyDesc& d) { d.inertia_B(1, 1) = kNan; },
      [&](BodyDesc& d) { d.shapes[0].hull = &broken; },
      [&](BodyDesc& d) { d.shapes[0].hull = &flat; },
      [&](BodyDesc& d) { d.shapes[0].hull = &none; },
      [&](BodyDesc& d) { d.shapes[0].hull = nullptr; },
      [&](BodyDesc& d) { d.shapes[0].friction = -1; },
      [&](BodyDesc& d) { d.shapes[0].restitution = kNan; },
      [&](BodyDesc& d) { d = W::sphere(0, Vec3::Zero()), d.mass_kg = 1; },
      [&](BodyDesc& d) { d = W::sphere(kNan, Vec3::Zero()), d.mass_kg = 1; },
      [&](BodyDesc& d) { d = W::ground(Vec3::Zero()); }};
  RigidWorld world;
  world.add(W::ground());
  const BodyId kept = world.add(good);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    std::vector<BodyDesc> add = {good, good};
    faults[i](add[1]);
    EXPECT_THROW(world.physics().replace(std::span(&kept, 1), add), InputError) << "fault " << i;
  }
  const SolveReport report = world.step(1.0 / 60, 4);
  EXPECT_EQ(report.awake, 1u);
  EXPECT_EQ(report.contacts, 1u);
}

/// Figures of a burst of boxes of 20 cm in one place, displaced by `jitter_m` in random directions.
struct Burst {
  double gained_J = 0;  ///< Maximum of the total energy above its start.
  double allowed_J = 0;
  double points_a_body = 0;  ///< Maximum over all steps.
};

Burst burst(int count, double jitter_m, int steps) {
  RigidWorld world(awake());
  Random random(1);
  std::vector<double> masses;
  world.add(W::ground());
  masses.push_back(0);
  Burst heap;
  for (int i = 0; i < count; ++i) {
    const BodyDesc box =
        W::box(Vec3(0.2, 0.2, 0.2), Vec3(0, 2, 0) + jitter_m * Vec3(random.direction()));
    heap.allowed_J += 0.5 * box.mass_kg * std::pow(correction_speed_m_s(0.2, kG), 2);
    masses.push_back(box.mass_kg);
    world.add(box);
  }
  const double start_J = potential_energy(world, masses);
  for (int i = 0; i < steps; ++i) {
    const SolveReport report = world.step(1.0 / 60, 4);
    const double energy_J = world.kinetic_energy() + potential_energy(world, masses);
    heap.gained_J = std::max(heap.gained_J, energy_J - start_J);
    heap.points_a_body =
        std::max(heap.points_a_body, static_cast<double>(report.contact_points) / count);
  }
  EXPECT_TRUE(finite(world));
  std::printf("%d boxes within %.0e m: gained %.3g J of %.3g J allowed, %.0f points a body\n",
              count, jitter_m, heap.gained_J, heap.allowed_J, heap.points_a_body);
  return heap;
}

// Points per body of a heap of boxes at rest: 3 contacts of 4 points.
constexpr double kRestingPoints = 12;

TEST(Extremes, AThousandBodiesInOnePlacePartWithBoundedEnergyAndWork) {
  for (const double jitter_m : {0.0, 1e-3, 0.05}) {
    const Burst heap = burst(1000, jitter_m, jitter_m == 0 ? 60 : 30);
    EXPECT_LE(heap.gained_J, heap.allowed_J);
    EXPECT_LE(heap.points_a_body, 10 * kRestingPoints);
  }
}

TEST(Extremes, ThreeThousandBodiesInOnePlacePartWithBoundedEnergyAndWork) {
  const Burst heap = burst(3000, 0, 8);
  EXPECT_LE(heap.gained_J, heap.allowed_J);
  EXPECT_LE(heap.points_a_body, 10 * kRestingPoints);
}

// Midpoint steps of more than a radian diverge; small fragments under fire reach such spins.
TEST(Extremes, BodiesThatSpinByRadiansPerStepStayFinite) {
  for (const double turn_s : {1e3, 2e4, 3e5, 1e7}) {
    RigidWorld world(awake());
    BodyDesc sliver = W::box(Vec3(8e-3, 1e-3, 4e-3), Vec3(0, 1, 0));
    sliver.angular_velocity_W = turn_s * Vec3(0.6, 0.64, 0.48);
    const BodyId id = world.add(sliver);
    const double before_J = world.kinetic_energy();
    for (int i = 0; i < 10; ++i) world.step(1.0 / 120, 4);
    ASSERT_TRUE(finite(world));
    EXPECT_GT(world.state(id).angular_velocity_W.norm(), 0.1 * turn_s)
        << "the body must not be frozen";
    EXPECT_LT(world.kinetic_energy(), 1.5 * before_J + 1);
  }
}

TEST(Extremes, AHundredThousandBodiesGiveTheSameBitsForAnyNumberOfThreads) {
  const auto run = [](int count) {
    set_threads(count);
    RigidWorld world(awake());
    std::vector<BodyDesc> bodies = {W::ground()};
    const BodyDesc box = W::box(Vec3(0.2, 0.2, 0.2), Vec3::Zero());
    for (int i = 0; i < 100000; ++i) {
      bodies.push_back(box);
      bodies.back().X_WB.position =
          Vec3(0.25 * (i % 200), 0.1 + 0.2 * (i / 200 % 5), 0.25 * (i / 1000));
    }
    const std::vector<BodyId> ids = world.physics().replace({}, bodies);
    for (int i = 0; i < 2; ++i) world.step(1.0 / 60, 2);
    double hash = 0;
    for (std::size_t i = 1; i < ids.size(); ++i) {
      const BodyState s = world.state(ids[i]);
      hash = hash * 0.9999 + s.X_WB.position.sum() + 1e3 * s.velocity_W.sum();
    }
    return hash;
  };
  const double one = run(1);
  EXPECT_TRUE(std::isfinite(one));
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(4));
  set_threads(1);
}

/// Returns the distance of the top box of a stack of ten from its place after two seconds, in m.
double stack_error(double dt_s, double x_m = 0) {
  RigidWorld world(awake());
  world.add(W::ground());
  for (int i = 0; i < 10; ++i) world.add(W::box(Vec3(1, 1, 1), Vec3(x_m, 0.5 + i, 0)));
  world.run(2, dt_s, 4);
  EXPECT_TRUE(finite(world));
  return (world.state(world.id(10)).X_WB.position - Vec3(x_m, 9.5, 0)).norm();
}

TEST(Extremes, AStackStandsFromATwentiethOfASecondDownAndSinksLessWithEveryShorterStep) {
  EXPECT_TRUE(std::isfinite(stack_error(1.0 / 10)));
  double last = 1;
  for (const double rate : {20.0, 60.0, 240.0, 1000.0, 10000.0}) {
    const double error = stack_error(1 / rate);
    std::printf("stack of 10 at 1/%.0f s: error %.3g m\n", rate, error);
    EXPECT_LT(error, 0.5);  // The stack stands.
    EXPECT_LT(error, last + 1e-6);
    last = error;
  }
}

TEST(Extremes, AStackRestsAsWellTenKilometresFromTheOrigin) {
  const double near = stack_error(1.0 / 120), far = stack_error(1.0 / 120, 1e4);
  std::printf("stack of 10: error %.4g m at the origin, %.4g m at 10 km\n", near, far);
  EXPECT_LE(far, 1.1 * near);
}

/// Drops ten tilted boxes of this side, with times and steps scaled by √side. Returns their mean
/// height in sides, and their maximum speed in units of √(g·side).
std::pair<double, double> heap_of_size(double side_m) {
  RigidWorld world(awake());
  world.add(W::ground());
  for (int i = 0; i < 10; ++i) {
    BodyDesc box =
        W::box(Vec3(1, 1, 1) * side_m, Vec3(0.1 * (i % 3), 1 + 1.5 * i, 0.1 * (i % 2)) * side_m);
    box.X_WB.rotation = Quat(Eigen::AngleAxisd(0.2 * i, Vec3(1, i, 2).normalized()));
    world.add(box);
  }
  const double time = std::sqrt(side_m);
  world.run(16 * time, time / 128, 4);
  EXPECT_TRUE(finite(world));
  double height = 0;
  for (std::size_t i = 1; i < world.size(); ++i)
    height += world.state(world.id(i)).X_WB.position.y() / 10;
  return {height / side_m, max_speed(world) / std::sqrt(kG * side_m)};
}

TEST(Extremes, HeapsOfAMillimetreAndOfAKilometreLieAlike) {
  for (const double side_m : {1.0 / 1024, 1.0, 1024.0}) {
    const auto [height, speed] = heap_of_size(side_m);
    std::printf("boxes of %.3g m: lie %.3f sides high, fastest %.1e of what falls a side\n", side_m,
                height, speed);
    EXPECT_GT(height, 0.45);
    EXPECT_LT(height, 2);
    EXPECT_LT(speed, 0.02);
  }
}

}  // namespace
}  // namespace sunder::solver
