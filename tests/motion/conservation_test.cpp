// Tests that random breaks of moving solids conserve mass and momenta and gain no energy.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/fracture/ring.h"
#include "tests/motion/run.h"
#include "tests/motion/spy.h"

namespace sunder::tests {
namespace {

constexpr double kRelativeTolerance = 1e-6;

Compound random_compound(Random& random) {
  switch (random.below(4)) {
    case 0: {
      const Vec3 half(random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(0.1, 0.6));
      return fracture::box_compound(-half, half);
    }
    case 1:
      return fracture::voronoi_compound(2 + static_cast<int>(random.below(20)), random.bits());
    case 2:
      return fracture::grid_compound(1 + static_cast<int>(random.below(3)), 2,
                                     1 + static_cast<int>(random.below(2)), Vec3(0.3, 0.2, 0.4));
    default:
      return fracture::ring_compound(5 + static_cast<int>(random.below(6)), 0.3, 0.6, 0.3);
  }
}

struct Case {
  Scene scene;
  bool is_blast = false;
};

/// Picks the centre of a random face as the point where a ball touches the solid from outside.
/// Returns false if a convex of the solid is in the ball's way.
bool find_place(const Compound& compound, double radius_m, Random& random, Vec3& on_R,
                Vec3& normal_R) {
  const ConvexPolyhedron& hull =
      compound.convexes[random.below(static_cast<std::uint32_t>(compound.convexes.size()))]
          ->polyhedron;
  const std::size_t f = random.below(static_cast<std::uint32_t>(hull.faces.size()));
  on_R.setZero();
  for (const std::uint32_t corner : hull.face_corners(f)) on_R += hull.vertices[corner];
  on_R /= static_cast<double>(hull.face_corners(f).size());
  normal_R = hull.faces[f].plane.normal;
  const Vec3 center_R = on_R + radius_m * normal_R;
  return std::ranges::all_of(compound.convexes, [&](const ConvexPtr& convex) {
    double outside = -1e9;
    for (const ConvexPolyhedron::Face& face : convex->polyhedron.faces) {
      outside = std::max(outside, face.plane.distance(center_R));
    }
    return outside > 0.999 * radius_m;
  });
}

/// Returns a moving and spinning solid, about to be hit by a ball that touches it, or by a blast.
Case random_case(std::uint64_t seed) {
  Random random(seed, 77);
  Case one;
  one.scene = bare_scene(1.0 / 60, random.uniform(5, 200), random.uniform(100, 3000));
  one.scene.seed = seed;
  Material& brittle = one.scene.materials[0];
  brittle.pattern.cells = 3 + static_cast<int>(random.below(12));
  brittle.impact_radius_m = random.uniform(0.2, 1);
  brittle.friction = random.uniform();
  // In half of the cases some pieces are too small to be bodies.
  brittle.smallest_piece_m3 = seed % 2 == 0 ? 1e-9 : random.uniform(1e-5, 1e-3);
  Solid solid{"solid", random_compound(random), {}};
  brittle.smallest_break_m3 = 0.99 * volume(solid.compound);  // it breaks once
  solid.X_WR = {
      10 * random.direction(),
      Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1).normalized()};
  solid.velocity_W = random.uniform(0, 20) * random.direction();
  solid.angular_velocity_W = random.uniform(0, 5) * random.direction();
  const double radius = random.uniform(0.05, 0.3);
  Vec3 on_R, normal_R;
  while (!find_place(solid.compound, radius, random, on_R, normal_R)) continue;
  const Vec3 com_R = mass_of(solid.compound, one.scene.materials).com_R;
  const Vec3 arm_W = solid.X_WR.rotation * (on_R - com_R);
  const Vec3 normal_W = solid.X_WR.rotation * normal_R;
  one.is_blast = seed % 10 == 0;
  if (one.is_blast) {
    one.scene.blasts = {{0, solid.X_WR * Vec3(on_R + normal_R), 4, random.uniform(2e3, 2e4)}};
  } else {
    const Vec3 skin_W = solid.velocity_W + solid.angular_velocity_W.cross(arm_W);
    const Vec3 velocity = skin_W - random.uniform(15, 60) * normal_W + 5 * random.direction();
    one.scene.balls = {
        steel_ball(radius, solid.X_WR * Vec3(on_R + (radius + 3e-5) * normal_R), velocity)};
  }
  one.scene.solids = {std::move(solid)};
  return one;
}

/// Returns the momentum that the total mass and kinetic energy have in one direction, in N s.
double momentum_scale(const Motions& all) { return std::sqrt(2 * all.mass_kg * all.kinetic_J); }

void expect_same_momentum(const Motions& after, const Motions& before) {
  EXPECT_NEAR(after.mass_kg, before.mass_kg,
              kRelativeTolerance * before.mass_kg);  // rounding may make debris
  EXPECT_LT((after.momentum - before.momentum).norm(), kRelativeTolerance * momentum_scale(before));
}

void expect_same_spin(const Motions& after, const Motions& before) {
  constexpr double kReach_m = 12;  // largest distance of a body from the origin
  EXPECT_LT((after.spin - before.spin).norm(),
            kRelativeTolerance * momentum_scale(before) * kReach_m);
}

/// Runs one case and returns its number of breaks.
std::size_t check(std::uint64_t seed) {
  const Case one = random_case(seed);
  auto spy = std::make_unique<SpyPhysics>(solver::make_rigid_physics({one.scene.gravity_W}));
  SpyPhysics& physics = *spy;
  Simulation simulation(one.scene, std::move(spy), fracture::make_pattern_breaker());
  const double mass_kg = simulation.next()->report.mass_kg;
  const double least_piece_m3 = one.scene.materials[0].smallest_piece_m3;
  const FramePtr first = simulation.next();
  const SpyPhysics::Balance breaks = physics.breaks;
  const Motions& before = breaks.before;
  for (const SpyPhysics::Replacement& broken : physics.replacements) {
    EXPECT_LE(broken.after.kinetic_J, broken.before.kinetic_J * (1 + kRelativeTolerance));
    if (least_piece_m3 >= 1e-6) continue;  // debris takes its momentum along
    expect_same_momentum(broken.after, broken.before);
    expect_same_spin(broken.after, broken.before);
  }
  const FramePtr last = simulation.next();
  EXPECT_NEAR(last->report.mass_kg, mass_kg, 1e-9 * mass_kg);
  EXPECT_LT(first->report.momentum_residual, 1e-4);  // solves are in single precision
  double taken_J = 0;
  for (const BreakEvent& event : first->breaks) taken_J += one.is_blast ? 0 : event.energy_J;
  EXPECT_LE(breaks.after.kinetic_J,
            before.kinetic_J - taken_J + kRelativeTolerance * before.kinetic_J);
  // Bodies turn on until an impact within the step, so spin is exact only for each replacement.
  if (least_piece_m3 < 1e-6) expect_same_momentum(breaks.after, before);
  return first->breaks.size();
}

TEST(Conservation, AThousandRandomBreaksInMotionKeepMassAndMomentumAndGainNoEnergy) {
  std::size_t breaks = 0;
  for (std::uint64_t seed = 1; breaks < 1000 && seed < 3000; ++seed) {
    breaks += check(seed);
    if (testing::Test::HasFailure()) {
      FAIL() << "case " << seed << ", after " << breaks << " breaks";
    }
  }
  EXPECT_GE(breaks, 1000u);
}

/// Returns the energy gained in solves of ten steps from a break on, relative to the largest.
double energy_gain_of_solves(std::uint64_t seed) {
  const Case one = random_case(seed);
  auto spy = std::make_unique<SpyPhysics>(solver::make_rigid_physics({one.scene.gravity_W}));
  const SpyPhysics& physics = *spy;
  Simulation simulation(one.scene, std::move(spy), fracture::make_pattern_breaker());
  simulation.next();
  double gained_J = 0, most_J = 0;
  for (int step = 0; step < 10; ++step) {
    simulation.next();
    most_J = std::max(most_J, physics.before_solve.kinetic_J);
    gained_J += std::max(0.0, physics.after_solve.kinetic_J - physics.before_solve.kinetic_J);
  }
  return gained_J / most_J;
}

TEST(Conservation, PiecesOfABreakInMotionSeparateWithoutGainingEnergy) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed)
    EXPECT_LT(energy_gain_of_solves(seed), kRelativeTolerance) << "case " << seed;
}

TEST(Conservation, AWheelThatBurstsBySpinKeepsMassMomentaAndEnergy) {
  Scene scene = bare_scene(1.0 / 120, 50, 2000);
  scene.materials[0].tensile_Pa = 1e5;
  Solid wheel{"wheel", fracture::ring_compound(24, 0.8, 1, 0.2), {}};
  wheel.velocity_W = Vec3(3, 2, 1);
  wheel.angular_velocity_W = Vec3(1, 0, 12);  // it bursts at 7.9
  scene.solids = {wheel};
  auto spy = std::make_unique<SpyPhysics>(solver::make_rigid_physics({scene.gravity_W}));
  const SpyPhysics& physics = *spy;
  Simulation simulation(scene, std::move(spy), fracture::make_pattern_breaker());
  simulation.next();
  simulation.next();
  ASSERT_GT(physics.replacements.size(), 0u);
  for (const SpyPhysics::Replacement& burst : physics.replacements) {
    expect_same_momentum(burst.after, burst.before);
    expect_same_spin(burst.after, burst.before);
    EXPECT_NEAR(burst.after.kinetic_J, burst.before.kinetic_J,
                kRelativeTolerance * burst.before.kinetic_J);
  }
}

/// A needle hit off its axis spins with the solver's bounded inertia, not with its own small one.
TEST(Conservation, ReportsTheEnergyOfANeedleWithTheInertiaOfTheSolver) {
  Scene scene = bare_scene(1.0 / 240, 100, 1000);
  scene.materials[1].restitution = 1;
  scene.solids = {box_solid(Vec3::Zero(), Vec3(2, 0.008, 0.008), 0, kSteel)};
  scene.balls = {steel_ball(0.02, Vec3(0, 0.05, 0.003), Vec3(0, -2, 0))};
  Trial run(scene);
  const double before_J = run.kinetic_J();
  while (run.frame->time_s < 0.1) run.step();
  EXPECT_GT(run.body(0).angular_velocity_W.norm(), 1);
  EXPECT_NEAR(run.kinetic_J(), before_J, 1e-3 * before_J);
}

}  // namespace
}  // namespace sunder::tests
