// Tests that an impact propagates through all touching bodies within one step (docs/decisions/036).
// bench/truths/through.cpp measures impacts through rubble.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "tests/fixtures/presets.h"

namespace sunder::solver::impact_test {
namespace {

using W = RigidWorld;
constexpr double kDt_s = 1.0 / 120, kSpeed_m_s = 100;
// Number of posts per side; there are more posts than colours.
constexpr int kSubsteps = 4, kSide = 10;

/// Returns a world in which a plate strikes posts that touch a second plate; all bodies are free.
RigidWorld plate_strikes_posts(int lanes) {
  RigidOptions options = awake(Vec3::Zero());
  options.lanes = lanes;
  RigidWorld world(options);
  const Vec3 plate(kSide, 0.2, kSide), post(0.5, 1, 0.5);
  world.add(W::moving(W::box(plate, Vec3(0, 0.6, 0)), Vec3(0, -kSpeed_m_s, 0)));
  world.add(W::box(plate, Vec3(0, -0.6, 0)));
  for (int i = 0; i < kSide * kSide; ++i)
    world.add(W::box(post, Vec3(i % kSide - 4.5, 0, i / kSide - 4.5), 100));
  return world;
}

TEST(Impact, PropagatesInOneStepThroughMoreContactsThanColours) {
  RigidWorld world = plate_strikes_posts(0);
  const Vec3 before = world.momentum();
  const double common_m_s = before.y() / world.step(kDt_s, kSubsteps).mass_kg;
  for (std::size_t i = 0; i < world.size(); ++i)
    EXPECT_NEAR(world.state(world.id(i)).velocity_W.y() / common_m_s, 1, 0.15) << i;
  EXPECT_NEAR(world.momentum().y() / before.y(), 1, 1e-5);
}

TEST(Impact, GivesTheSameBitsForAnyNumberOfThreadsAndLanes) {
  const int before = threads();
  const auto hash = [](int lanes, int thread_count) {
    set_threads(thread_count);
    RigidWorld world = plate_strikes_posts(lanes);
    for (int i = 0; i < 10; ++i) world.step(kDt_s, kSubsteps);
    return world.hash();
  };
  const std::uint64_t one = hash(1, 1);
  for (const int lanes : {4, 8, 16}) EXPECT_EQ(hash(lanes, 2), one) << lanes;
  EXPECT_EQ(hash(0, 5), one);
  set_threads(before);
}

/// Returns the fraction of its speed that a row of boxes loses in a channel of boxes that it fills.
/// Corners of the row pass corners of the sides.
double slowed_in_channel(double across_m, double dt_s) {
  constexpr int kBoxes = 4;
  constexpr double kBox_m = 0.2;
  RigidWorld world(awake(Vec3::Zero()));
  const auto row = [&](double x_m, double width_m) {
    BodyDesc desc = W::box(Vec3(width_m, kBox_m, kBoxes * kBox_m), Vec3(x_m, 0, 0), 2000);
    desc.shapes.clear();
    for (int i = 0; i < kBoxes; ++i) {
      const Vec3 half(width_m / 2, kBox_m / 2, kBox_m / 2);
      const Vec3 middle(0, 0, kBox_m * (i - 0.5 * (kBoxes - 1)));
      ShapeDesc shape = W::hull(make_box(middle - half, middle + half), Vec3::Zero()).shapes[0];
      shape.friction = 0;
      shape.tag = static_cast<std::uint32_t>(i);
      desc.shapes.push_back(shape);
    }
    return desc;
  };
  for (const double side : {-1.0, 1.0})
    world.add(W::fixed(row(side * (across_m / 2 + kBox_m), 2 * kBox_m)));
  const BodyId id = world.add(W::moving(row(0, across_m), Vec3(0, 0, -kSpeed_m_s)));
  for (int i = 0; i < 0.02 / dt_s; ++i) world.step(dt_s, kSubsteps);
  return 1 + world.state(id).velocity_W.z() / kSpeed_m_s;
}

TEST(Impact, DoesNotHappenWhereShapesSlidePastEachOther) {
  for (const double dt_s : {1.0 / 60, 1.0 / 120, 1.0 / 480, 1.0 / 1920})
    for (const double across_m : {0.2, 0.17, 0.5})
      EXPECT_NEAR(slowed_in_channel(across_m, dt_s), 0, 1e-4) << across_m << " m, " << dt_s;
}

/// Returns the error of a collision of two smooth balls on crossing paths that meet after `meet_s`:
/// the maximum of the velocity errors against the closed form and a tenth of the surface speed of
/// spin, over the speed.
double crossing_error(double speed_m_s, double meet_s, double dt_s, int substeps) {
  const double radius_m = 0.05;
  const Vec3 along_a = speed_m_s * Vec3::UnitX(), along_b = speed_m_s * Vec3::UnitZ();
  const Vec3 start_a = -meet_s * along_a, start_b = -meet_s * along_b + radius_m * Vec3::UnitZ();
  RigidWorld world(awake(Vec3::Zero()));
  const auto add = [&](const Vec3& start, const Vec3& velocity) {
    return world.add(W::with_friction(W::moving(W::sphere(radius_m, start), velocity), 0));
  };
  const BodyId a = add(start_a, along_a), b = add(start_b, along_b);
  world.run(0.1, dt_s, substeps);
  const Vec3 start = start_b - start_a, v = along_b - along_a;
  const double half = start.dot(v), square = v.squaredNorm();
  const double apart = start.squaredNorm() - 4 * radius_m * radius_m;
  const double time_s = -(half + std::sqrt(half * half - square * apart)) / square;
  const Vec3 normal = (start + time_s * v).normalized(), change = 0.5 * v.dot(normal) * normal;
  const BodyState end_a = world.state(a), end_b = world.state(b);
  return std::max({(end_a.velocity_W - along_a - change).norm(),
                   (end_b.velocity_W - along_b + change).norm(),
                   0.1 * radius_m * end_a.angular_velocity_W.norm()}) /
         speed_m_s;
}

TEST(Impact, OfBallsOnCrossingPathsMatchesTheClosedFormAtAnyStep) {
  for (const double speed_m_s : {5.0, 20.0, 60.0, 500.0}) {
    for (const int hertz : {30, 60, 90, 120, 180, 240, 480, 960}) {
      for (const int substeps : {1, 4, 8}) {
        for (int i = 0; i < 5; ++i) {
          const double meet_s = 0.04 + 0.0037 * i;
          EXPECT_LT(crossing_error(speed_m_s, meet_s, 1.0 / hertz, substeps), 0.01)
              << speed_m_s << " m/s, met after " << meet_s << " s, " << hertz << " Hz, "
              << substeps;
        }
      }
    }
  }
}

}  // namespace
}  // namespace sunder::solver::impact_test
