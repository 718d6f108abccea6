// Tests that a flow that is linear in space is exact at every point, its gradient included.
#include "solver/particles/flow.h"

#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::solver {
namespace {

/// Flow with u = A·(p − origin) at each face's centre.
struct LinearFlow : Flow {
  explicit LinearFlow(const Mat3f& A, double cell_m = 0.25) : Flow({12, 10, 8}) {
    grid_.origin_W = Vec3(1, -2, 3);
    grid_.cell_m = cell_m;
    const Lattice& lattice = grid_.lattice;
    const Vec3i last = lattice.counts + Vec3i::Constant(2);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3f half = 0.5f * (Vec3f::Ones() + Vec3f::Unit(axis));
      for (int k = 0; k <= last.z(); ++k) {
        for (int j = 0; j <= last.y(); ++j) {
          for (int i = 0; i <= last.x(); ++i) {
            const Vec3f at = static_cast<float>(cell_m) * (Vec3f(i, j, k) - half);
            of(velocity_, axis)[lattice.index(i, j, k)] = A.row(axis).dot(at);
          }
        }
      }
    }
  }
  LinearFlow resampled(const Grid& grid) const {
    LinearFlow other(Mat3f::Zero());
    resample(grid, other.velocity_);
    other.grid_ = grid;
    return other;
  }
};

Mat3f some_gradient() {
  Mat3f A;
  A << 1, 2, -3, 5, -7, 11, -13, 17, 19;
  return A;
}

/// Returns a random point; with `rim` = 0.1, more than half a cell from the sides of the grid.
Vec3 random_point(Random& random, const Grid& grid, double rim = 0) {
  const auto uniform = [&] { return random.uniform(rim, 1 - rim); };
  const Vec3 part(uniform(), uniform(), uniform());
  return grid.origin_W + part.cwiseProduct(grid.extent_m());
}

TEST(Lattice, TheLargestMagnitudeOfARowIsFoundAtAnyIndex) {
  for (int count = 1; count <= 19; ++count) {
    for (int at = 0; at < count; ++at) {
      std::vector<float> row(static_cast<std::size_t>(count), 1.0f);
      row[static_cast<std::size_t>(at)] = -2;
      ASSERT_EQ(largest_in(row.data(), count), 2) << at << " of " << count;
    }
  }
}

TEST(Flow, HasTheGradientOfALinearField) {
  const Mat3f A = some_gradient();
  const LinearFlow flow(A);
  for (const Vec3i& cell : {Vec3i(1, 1, 1), Vec3i(5, 4, 3), Vec3i(12, 10, 8)}) {
    const FlowGradient gradient = flow.gradient(cell);
    EXPECT_LE((gradient.strain_s - 0.5f * (A + A.transpose())).norm(), 1e-3f);
    const Vec3f curl(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
    EXPECT_LE((gradient.vorticity_s - curl).norm(), 1e-3f);
  }
}

TEST(Flow, IsExactBetweenTheFacesOfALinearFieldAndZeroBeyondThem) {
  const Mat3f A = some_gradient();
  const LinearFlow flow(A);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 point = random_point(random, flow.grid());
    const Vec3f expected = A * (point - flow.grid().origin_W).cast<float>();
    ASSERT_LE((flow.velocity(point.cast<float>()) - expected).norm(), 1e-3f) << point;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 beyond = flow.grid().extent_m()[axis] * Vec3::Unit(axis);
    const Vec3 inside = flow.grid().origin_W + 0.5 * flow.grid().extent_m();
    EXPECT_EQ(flow.velocity((inside + beyond).cast<float>()), Vec3f::Zero());
    EXPECT_EQ(flow.velocity((inside - beyond).cast<float>()), Vec3f::Zero());
  }
}

TEST(Flow, IsTheSameOnAnotherGridWithinIt) {
  const Mat3f A = some_gradient();
  const LinearFlow flow(A);
  Grid finer = flow.grid();
  finer.cell_m = 0.15;
  finer.origin_W += Vec3(0.4, 0.3, 0.35);
  const LinearFlow other = flow.resampled(finer);
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3 point = random_point(random, finer, 0.1);
    const Vec3f expected = A * (point - flow.grid().origin_W).cast<float>();
    ASSERT_LE((other.velocity(point.cast<float>()) - expected).norm(), 1e-3f) << point;
  }
}

TEST(Flow, HasTheDivergenceOfItsGradientsTrace) {
  const Mat3f stretch = Vec3f(1, 2, -4).asDiagonal();
  const LinearFlow flow(stretch);
  // The largest velocity is on z's lower faces, at most 7 cells of 0.25 m from the corner.
  EXPECT_NEAR(flow.divergence(), 0.25f * 1 / (4 * 7 * 0.25f), 1e-5f);
  EXPECT_EQ(LinearFlow(Mat3f::Zero()).divergence(), 0);
}

}  // namespace
}  // namespace sunder::solver
