// Tests of the air: no divergence, obstacles that move it, the weight of dust, and its grid.
#include "solver/particles/air.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/particles/particles_fixtures.h"

namespace sunder::solver {
namespace {

constexpr double kDt = 1.0 / 60;
const Vec3 kGravity(0, -9.81, 0);
const Vec3i kCounts(32, 16, 32);

/// Returns a grid of 4 × 2 × 4 m with cells of 12.5 cm about a point.
Air air_about(const Vec3& center) {
  Air air(kCounts);
  air.place(Box{center - Vec3::Constant(0.2), center + Vec3::Constant(0.2)}, 0);
  return air;
}

TEST(Air, IsFreeOfDivergenceAfterEveryStep) {
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0.8, 1, 0), Vec3(0.06, 0.5, 0.7), Quat(0.9, 0.1, 0.3, 0.2).normalized());
  obstacles.set_velocity(obstacles.add_box(Vec3(-0.5, 0.4, 0), Vec3(0.1, 0.4, 0.4)),
                         Vec3(3, 0.5, 0));
  obstacles.add_ball(Vec3(0, 1.5, 0.5), 0.3);
  Air air = air_about(Vec3(0, 1, 0));
  Random random(1);
  for (int step = 0; step < 20; ++step) {
    air.clear_loads();
    const Vec3f at = random.direction().cast<float>() * 0.4f + Vec3f(0, 1, 0);
    const Vec3i cell = air.cell_at(at);
    const std::size_t index = air.grid().lattice.index(cell.x(), cell.y(), cell.z());
    air.add_dust(index, 1e-3f);
    air.add_momentum(index, 1e-3f, 10 * random.direction().cast<float>());
    obstacles.advance(kDt);
    air.advance(kDt, kGravity, obstacles.view());
    ASSERT_GT(air.velocity(Vec3f(-0.2f, 0.5f, 0)).norm(), 0);
    ASSERT_LE(air.divergence(), 1e-3f) << "step " << step;
  }
}

TEST(Air, WithoutSourcesStaysAtRest) {
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0, 0.5, 0), Vec3(0.5, 0.5, 0.2));
  Air air = air_about(Vec3(0, 1, 0));
  for (int step = 0; step < 5; ++step) air.advance(kDt, kGravity, obstacles.view());
  EXPECT_EQ(air.velocity(Vec3f(0.3f, 0.8f, 0.4f)), Vec3f::Zero());
  EXPECT_EQ(air.iterations(), 0);
}

TEST(Air, IsDisplacedByAMovingSlab) {
  TestObstacles obstacles;
  obstacles.set_velocity(obstacles.add_box(Vec3(0, 0.9, 0), Vec3(0.05, 0.4, 0.4)), Vec3(2, 0, 0));
  Air air = air_about(Vec3(0, 0.9, 0));
  air.advance(kDt, Vec3::Zero(), obstacles.view());
  // At the slab the air moves with it; before and behind it, in the same direction, but slower.
  EXPECT_NEAR(air.velocity(Vec3f(0, 0.9f, 0)).x(), 2, 0.2);
  EXPECT_GT(air.velocity(Vec3f(0.4f, 0.9f, 0)).x(), 0.2f);
  EXPECT_GT(air.velocity(Vec3f(-0.4f, 0.9f, 0)).x(), 0.2f);
  // Displaced air returns around the slab's edges.
  EXPECT_LT(air.velocity(Vec3f(0, 0.9f, 0.7f)).x(), -0.05f);
  EXPECT_LT(air.velocity(Vec3f(0, 1.6f, 0)).x(), -0.02f);
  // The air moves outward ahead of the slab, and inward behind it.
  EXPECT_GT(air.velocity(Vec3f(0.25f, 0.9f, 0.5f)).z(), 0.02f);
  EXPECT_LT(air.velocity(Vec3f(-0.25f, 0.9f, 0.5f)).z(), -0.02f);
}

TEST(Air, IsSolvedInFewIterationsForASourceAnywhere) {
  const TestObstacles obstacles;
  for (const int i : {1, 16, 32}) {
    Air air = air_about(Vec3(0, 1, 0));
    const std::size_t cell = air.grid().lattice.index(i, 8, 16);
    air.add_dust(cell, 1e-3f);
    air.add_momentum(cell, 1e-3f, Vec3f(10, 0, 0));
    air.advance(kDt, Vec3::Zero(), obstacles.view());
    EXPECT_GT(air.iterations(), 0) << i;
    EXPECT_LE(air.iterations(), 6) << i;
  }
}

TEST(Air, DoesNotPassAWall) {
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0.6, 1, 0), Vec3(0.1, 5, 5));
  obstacles.set_velocity(obstacles.add_box(Vec3(0, 0.9, 0), Vec3(0.1, 0.4, 0.4)), Vec3(2, 0, 0));
  Air air = air_about(Vec3(0, 0.9, 0));
  for (int step = 0; step < 5; ++step) air.advance(kDt, Vec3::Zero(), obstacles.view());
  EXPECT_LT(air.velocity(Vec3f(1, 0.9f, 0)).norm(), 0.05f);
  EXPECT_GT(air.velocity(Vec3f(0.25f, 0.9f, 0)).norm(), 0.3f);
}

TEST(Air, SinksUnderTheWeightOfDust) {
  const TestObstacles obstacles;
  Air air = air_about(Vec3(0, 1, 0));
  const Vec3i cell = air.cell_at(Vec3f(0, 1, 0));
  for (int step = 0; step < 10; ++step) {
    air.clear_loads();
    for (int k = -2; k < 2; ++k) {
      for (int i = -2; i < 2; ++i) {
        air.add_dust(air.grid().lattice.index(cell.x() + i, cell.y(), cell.z() + k), 1e-3f);
      }
    }
    air.advance(kDt, kGravity, obstacles.view());
  }
  EXPECT_LT(air.velocity(Vec3f(0, 1, 0)).y(), -0.1f);
}

TEST(Air, LosesItsEnergyWithoutSources) {
  const TestObstacles obstacles;
  Air air = air_about(Vec3(0, 1, 0));
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Vec3i cell = air.cell_at(Vec3f(0, 1, 0) + 0.5f * random.direction().cast<float>());
    const std::size_t index = air.grid().lattice.index(cell.x(), cell.y(), cell.z());
    air.add_dust(index, 1e-9f);
    air.add_momentum(index, 2e-3f, 10 * random.direction().cast<float>());
  }
  const auto energy = [&air] {
    double sum = 0;
    for (int i = -15; i < 15; ++i) {
      for (int k = -15; k < 15; ++k) {
        for (int j = 0; j < 16; ++j) {
          const Vec3f at = 0.125f * Vec3f(float(i), float(j), float(k));
          sum += double{air.velocity(at).squaredNorm()};
        }
      }
    }
    return sum;
  };
  air.advance(kDt, Vec3::Zero(), obstacles.view());
  air.clear_loads();
  const double first = energy();
  double last = first;
  ASSERT_GT(first, 10);
  for (int step = 1; step <= 600; ++step) {
    air.advance(kDt, Vec3::Zero(), obstacles.view());
    if (step % 20 != 0) continue;
    EXPECT_LT(energy(), 1.01 * last) << "step " << step;
    last = energy();
  }
  EXPECT_LT(last, 0.2 * first);
}

TEST(Air, KeepsItsVelocityWhenTheGridMovesOrCoarsens) {
  TestObstacles obstacles;
  obstacles.set_velocity(obstacles.add_box(Vec3(0, 1, 0), Vec3(0.3, 0.3, 0.3)), Vec3(2, 0, 1));
  Air air = air_about(Vec3(0, 1, 0));
  for (int step = 0; step < 10; ++step) air.advance(kDt, Vec3::Zero(), obstacles.view());
  const Vec3f at(0.2f, 1.1f, 0.1f);
  const Vec3f before = air.velocity(at);
  const double cell_m = air.grid().cell_m;
  ASSERT_GT(before.norm(), 0.5f);
  ASSERT_TRUE(air.place(Box{Vec3(1.2, 0.9, 0), Vec3(1.9, 1.2, 0.2)}, 0));
  EXPECT_EQ(air.grid().cell_m, cell_m);
  EXPECT_LT((air.velocity(at) - before).norm(), 1e-5f);
  ASSERT_TRUE(air.place(Box{Vec3(-2, 0.5, -2), Vec3(2, 1.5, 2)}, 0));
  EXPECT_GT(air.grid().cell_m, cell_m);
  EXPECT_LT((air.velocity(at) - before).norm(), 0.15f * before.norm());
}

TEST(Air, EndsAtTheGround) {
  Air air(kCounts);
  air.place(Box{Vec3(-0.1, 0.7, -0.1), Vec3(0.1, 0.8, 0.1)}, 0.35);
  EXPECT_EQ(air.grid().origin_W.y(), 0.35);
  EXPECT_TRUE(air.grid().on_ground);
  TestObstacles obstacles;
  obstacles.ground_m = 0.35;
  obstacles.set_velocity(obstacles.add_box(Vec3(0, 0.8, 0), Vec3(0.4, 0.05, 0.4)), Vec3(0, -2, 0));
  air.advance(kDt, Vec3::Zero(), obstacles.view());
  EXPECT_EQ(air.velocity(Vec3f(0.1f, 0.35f, 0.1f)).y(), 0);
  EXPECT_GT(air.velocity(Vec3f(0.5f, 0.5f, 0)).x(), 0.1f) << "squeezed out sideways";
}

TEST(Solids, KeepTheirVolumeForAnyAlignmentWithTheCells) {
  TestObstacles obstacles;
  obstacles.add_box(Vec3(0.13, 0.97, 0.21), Vec3(0.33, 0.02, 0.51));
  obstacles.add_box(Vec3(-0.8, 1.01, 0.04), Vec3(0.01, 0.02, 0.03));
  const Air air = air_about(Vec3(0, 1, 0));
  Solids solids;
  solids.rasterize(air.grid(), obstacles.view());
  double cells = 0;
  for (const float part : solids.fraction) cells += double{part};
  const double volume_m3 = 8 * (0.33 * 0.02 * 0.51 + 0.01 * 0.02 * 0.03);
  EXPECT_NEAR(cells * std::pow(air.grid().cell_m, 3), volume_m3, 1e-3 * volume_m3);
}

TEST(PressureSolver, ReachesItsToleranceInAClosedRoomWithALeak) {
  const Vec3i counts(32, 16, 16);
  PressureSolver solver(counts);
  const Lattice lattice{counts};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3i last = counts + Vec3i::Unit(axis);
    for (int k = 1; k <= last.z(); ++k) {
      for (int j = 1; j <= last.y(); ++j) {
        for (int i = 1; i <= last.x(); ++i) {
          const bool rim = Vec3i(i, j, k)[axis] == 1 || Vec3i(i, j, k)[axis] == last[axis];
          const bool wall = axis == 0 && (i == 10 || i == 20);
          of(solver.coefficients(), axis)[lattice.index(i, j, k)] = rim ? 2 : wall ? 0.02f : 1;
        }
      }
    }
  }
  solver.inflow()[lattice.index(15, 8, 8)] = 1;
  solver.inflow()[lattice.index(12, 4, 3)] = -0.5f;
  EXPECT_LE(solver.solve(1e-5f), 9);
  for (const float left : solver.inflow()) ASSERT_LE(std::abs(left), 1e-5f);
}

}  // namespace
}  // namespace sunder::solver
