// Tests that the scheme of the contact solver changes the convergence and not the solution:
// colours, mass splitting (Tonge, Benevolenski, Voroshilov 2012), lanes and threads.
#include <array>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "solver/rigid/contact/kernels/sweep_kernels.h"
#include "tests/fixtures/rigid_world.h"

namespace sunder::solver::split_test {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 60;
constexpr int kColors[] = {0, 8, 64};

RigidOptions with(int max_colors, int sweeps = 1, int lanes = 0) {
  RigidOptions options;
  options.sleeping = false;
  // With a static warm start, the first sweep would be at the solution.
  options.static_warm_start = 0;
  options.max_colors = max_colors;
  options.sweeps = sweeps;
  options.accelerated = false;
  options.lanes = lanes;
  return options;
}

std::vector<BodyDesc> stack(int count) {
  std::vector<BodyDesc> bodies = {W::ground()};
  for (int i = 0; i < count; ++i) bodies.push_back(W::box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0)));
  return bodies;
}

std::vector<BodyDesc> pyramid(int base) {
  std::vector<BodyDesc> bodies = {W::ground()};
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i)
      bodies.push_back(W::box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0)));
  return bodies;
}

/// Returns boxes and balls over a pit; a third of them bounces.
std::vector<BodyDesc> rubble(int count, double bounce) {
  std::vector<BodyDesc> bodies = {W::ground()};
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    bodies.push_back(W::ground(normal));
    bodies.back().X_WB.position = -1.2 * normal;
  }
  Random random(7);
  for (int i = 0; i < count; ++i) {
    const Vec3 at(0.5 * (i % 4) - 0.75 + random.uniform(-0.05, 0.05), 0.4 + 0.45 * (i / 16),
                  0.5 * (i / 4 % 4) - 0.75 + random.uniform(-0.05, 0.05));
    const double size = random.uniform(0.2, 0.42);
    BodyDesc body = i % 5 == 0 ? W::sphere(0.5 * size, at)
                               : W::box(size * Vec3(1, random.uniform(0.5, 1), 1), at);
    bodies.push_back(W::with_friction(body, 0.5, i % 3 == 0 ? bounce : 0));
  }
  return bodies;
}

void add(const std::vector<BodyDesc>& bodies, RigidWorld& world) {
  for (const BodyDesc& body : bodies) world.add(body);
}

/// Returns the bodies, without friction, in the state after that number of steps.
std::vector<BodyDesc> state_after(std::vector<BodyDesc> bodies, int steps) {
  for (BodyDesc& body : bodies) body = W::with_friction(body, 0);
  RigidWorld world(with(64));
  add(bodies, world);
  for (int i = 0; i < steps; ++i) world.step(kDt_s, 4);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyState state = world.state(world.id(i));
    bodies[i].X_WB = state.X_WB;
    bodies[i].velocity_W = state.velocity_W;
    bodies[i].angular_velocity_W = state.angular_velocity_W;
  }
  return bodies;
}

/// Returns the velocities after one step of that number of sweeps.
std::vector<Vec3> solve_velocities(const std::vector<BodyDesc>& bodies, int max_colors,
                                   int sweeps) {
  RigidWorld world(with(max_colors, sweeps));
  add(bodies, world);
  world.step(kDt_s, 1);
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyState state = world.state(world.id(i));
    velocities.push_back(state.velocity_W);
    velocities.push_back(state.angular_velocity_W);
  }
  return velocities;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

/// Returns the distances of the velocities after 1, 4, 16 ... sweeps from those after 50,000
/// coloured sweeps, divided by the first distance.
std::array<double, 8> residuals(const std::vector<BodyDesc>& bodies, int max_colors) {
  const std::vector<Vec3> converged = solve_velocities(bodies, 64, 50000);
  std::array<double, 8> all;
  for (int i = 0; i < 8; ++i)
    all[static_cast<std::size_t>(i)] =
        distance(solve_velocities(bodies, max_colors, 1 << 2 * i), converged);
  const double first = all[0];
  for (double& residual : all) residual /= first;
  return all;
}

void expect_convergence(const char* name, const std::vector<BodyDesc>& bodies) {
  for (const int max_colors : kColors) {
    const std::array<double, 8> curve = residuals(bodies, max_colors);
    std::printf("%-8s K = %2d:", name, max_colors);
    for (const double residual : curve) std::printf("  %.1e", residual);
    std::printf("\n");
    for (std::size_t i = 1; i < curve.size(); ++i)
      EXPECT_LT(curve[i], std::max(curve[i - 1], 1e-3)) << max_colors << " " << i;
    EXPECT_LT(curve.back(), 0.01) << max_colors;
  }
}

TEST(Splitting, KeepsTheSpringBetweenBodies) {
  const Spring<Wide> whole{splat<Wide>(0.8f), splat<Wide>(0.2f)};
  for (const float parts : {1.f, 2.f, 7.f}) {
    const Spring<Wide> spring = whole.split(splat<Wide>(parts));
    EXPECT_NEAR(spring.mass_scale[0] + spring.impulse_scale[0], 1, 1e-6);
    // The compliance between the bodies stays equal: impulse_scale / mass_scale grows by `parts`.
    EXPECT_NEAR(parts * spring.mass_scale[0] / spring.impulse_scale[0], 4, 1e-5);
  }
}

TEST(Splitting, SlowsASpinningBoxAsColouredSweepsDo) {
  std::array<double, 2> left_rad_s;
  for (std::size_t i = 0; i < 2; ++i) {
    RigidWorld world(with(i == 0 ? 0 : 64));
    std::vector<BodyDesc> bodies = stack(2);
    bodies[2].angular_velocity_W = Vec3(0, 5, 0);
    add(bodies, world);
    world.run(0.1, kDt_s, 8);
    left_rad_s[i] = world.state(world.id(2)).angular_velocity_W.y();
  }
  EXPECT_GT(left_rad_s[1], 0.5);
  EXPECT_LT(left_rad_s[1], 4);
  EXPECT_NEAR(left_rad_s[0], left_rad_s[1], 0.05 * left_rad_s[1]);
}

TEST(Splitting, ConvergesToTheSolutionOfColouredSweepsInAPile) {
  expect_convergence("rubble", state_after(rubble(48, 0), 50));
}

TEST(Splitting, ConvergesToTheSolutionOfColouredSweepsInAStackAndAPyramid) {
  expect_convergence("stack", state_after(stack(6), 0));
  expect_convergence("pyramid", state_after(pyramid(6), 0));
}

// Mass splitting alone needs four times the substeps, and creeps (docs/decisions/022).
TEST(Splitting, HoldsStacksAndPyramidsWithEnoughSubsteps) {
  for (const int max_colors : kColors) {
    for (const bool tall : {true, false}) {
      RigidWorld world(with(max_colors));
      const std::vector<BodyDesc> bodies = tall ? stack(10) : pyramid(5);
      add(bodies, world);
      world.run(5, 1.0 / 120, max_colors == 0 ? 32 : 8);
      double moved = 0;
      for (std::size_t i = 0; i < bodies.size(); ++i)
        moved = std::max(moved,
                         (world.state(world.id(i)).X_WB.position - bodies[i].X_WB.position).norm());
      std::printf("K = %2d, %s: moved %.2f mm\n", max_colors, tall ? "stack" : "pyramid",
                  1e3 * moved);
      EXPECT_LT(moved, 0.01) << max_colors;
    }
  }
}

/// Returns enough contacts for several threads, and a body with more neighbours than eight colours.
std::vector<BodyDesc> cubes_and_a_ball(int side) {
  std::vector<BodyDesc> bodies = {W::ground()};
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3 cell(i % side, i / side / side + 0.5, i / side % side);
    bodies.push_back(W::box(Vec3(0.2, 0.2, 0.2), 0.2 * cell));
  }
  const Vec3 above(0.1 * side, 0.2 * side + 0.45, 0.1 * side);
  bodies.push_back(W::with_friction(W::sphere(0.4, above, 3000), 0.5, 0.5));
  bodies.back().velocity_W = Vec3(0, -10, 0);
  return bodies;
}

/// Returns a plate on 100 posts: more contacts of one body than colours.
std::vector<BodyDesc> plate_on_posts() {
  std::vector<BodyDesc> bodies = {W::ground(), W::box(Vec3(10, 0.3, 10), Vec3(0, 1.15, 0))};
  for (int i = 0; i < 100; ++i)
    bodies.push_back(W::box(Vec3(0.3, 1, 0.3), Vec3(i % 10 - 4.5, 0.5, i / 10 - 4.5)));
  return bodies;
}

TEST(Splitting, HoldsAPlateWithMoreContactsThanColours) {
  RigidWorld world(with(64));
  add(plate_on_posts(), world);
  world.run(3, 1.0 / 120, 8);
  const BodyState plate = world.state(world.id(1));
  EXPECT_NEAR(plate.X_WB.position.y(), 1.15, 2e-3);
  EXPECT_LT(plate.velocity_W.norm(), 1e-3);
}

std::uint64_t hash_of(const std::vector<BodyDesc>& bodies, int steps, int max_colors, int lanes,
                      int thread_count) {
  set_threads(thread_count);
  RigidOptions options = with(max_colors, 1, lanes);
  options.sleeping = true;
  RigidWorld world(options);
  add(bodies, world);
  for (int i = 0; i < steps; ++i) world.step(kDt_s, 4);
  set_threads(0);
  return world.hash();
}

TEST(Lanes, GiveTheSameBitsForTenSeconds) {
  for (const auto& bodies : {rubble(40, 0.5), pyramid(6), plate_on_posts()}) {
    for (const int max_colors : kColors) {
      const std::uint64_t one = hash_of(bodies, 600, max_colors, 1, 1);
      for (const int lanes : {4, 8, 16})
        EXPECT_EQ(hash_of(bodies, 600, max_colors, lanes, 1), one) << lanes << " " << max_colors;
    }
  }
}

TEST(Lanes, GiveTheSameBitsForAnyNumberOfThreads) {
  const std::vector<BodyDesc> bodies = cubes_and_a_ball(8);
  constexpr int kSteps = 15;
  const std::uint64_t one = hash_of(bodies, kSteps, 64, 1, 1);
  for (const int lanes : {1, 4, 8, 16})
    for (const int thread_count : {1, 2, 4, 7})
      EXPECT_EQ(hash_of(bodies, kSteps, 64, lanes, thread_count), one)
          << lanes << " " << thread_count;
  for (const int max_colors : {0, 8}) {
    const std::uint64_t split = hash_of(bodies, kSteps, max_colors, 1, 1);
    EXPECT_NE(split, one);
    for (const auto& [lanes, thread_count] : {std::pair{4, 7}, {8, 2}, {16, 4}})
      EXPECT_EQ(hash_of(bodies, kSteps, max_colors, lanes, thread_count), split) << lanes;
  }
}

TEST(Lanes, AreAtMostTheRequestedNumber) {
  EXPECT_EQ(lanes_in_use(1), 1);
  EXPECT_EQ(lanes_in_use(4), 4);
  EXPECT_LE(lanes_in_use(8), 8);
  EXPECT_EQ(lanes_in_use(0), lanes_in_use(16));
}

}  // namespace
}  // namespace sunder::solver::split_test
