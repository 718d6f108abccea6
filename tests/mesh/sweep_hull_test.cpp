// Tests that a hull built point by point has the volume of its points so far, in closed form.
#include "fracture/vacd/sweep_hull.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::fracture {
namespace {

/// Restarts the hull on the corners of a cube of edge 1.
void grow_cube(SweepHull& hull) {
  hull.restart(Vec3::Constant(5), 1);
  for (int i = 0; i < 8; ++i) hull.add(Vec3(5 + (i & 1), 5 + (i >> 1 & 1), 5 + (i >> 2 & 1)));
}

// Points are joggled by 1e-5 of the size; the error of a volume is that times the surface.
TEST(SweepHull, HasTheVolumeOfEverySliceOfABox) {
  SweepHull hull;
  hull.restart(Vec3::Zero(), 4);
  for (int z = 0; z <= 8; ++z) {
    for (int y = 0; y <= 4; ++y) {
      for (int x = 0; x <= 4; ++x) hull.add(Vec3(0.5 * x, 0.75 * y, 0.5 * z));
    }
    ASSERT_NEAR(hull.volume_m3(), 2 * 3 * 0.5 * z, 52 * 4e-5) << "slice " << z;
  }
}

TEST(SweepHull, IsTheSameInAnyOrder) {
  Random random(2);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(random.direction());
  const auto volume_m3 = [&] {
    SweepHull hull;
    hull.restart(Vec3::Zero(), 2);
    for (const Vec3& point : points) hull.add(point);
    return hull.volume_m3();
  };
  const double volume = volume_m3();
  std::sort(points.begin(), points.end(),
            [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
  EXPECT_NEAR(volume_m3(), volume, 1e-3);
  std::reverse(points.begin(), points.end());
  EXPECT_NEAR(volume_m3(), volume, 1e-3);
}

TEST(SweepHull, AddsAPointOnlyIfItAddsMoreThanTheGivenVolume) {
  SweepHull hull;
  grow_cube(hull);
  ASSERT_NEAR(hull.volume_m3(), 1, 1e-4);
  EXPECT_FALSE(hull.add(Vec3(5.5, 5.5, 5.5))) << "inside";
  const auto apex = [](double height_m) { return Vec3(5.5, 5.5, 6 + height_m); };
  EXPECT_FALSE(hull.add(apex(0.297), 0.1)) << "a pyramid of 0.099";
  EXPECT_NEAR(hull.volume_m3(), 1, 1e-4);
  EXPECT_TRUE(hull.add(apex(0.303), 0.1)) << "a pyramid of 0.101";
  EXPECT_NEAR(hull.volume_m3(), 1.101, 1e-4);
}

TEST(SweepHull, CountsPointsAddedBeforeItHasAVolume) {
  SweepHull hull;
  hull.restart(Vec3::Zero(), 1);
  // Joggled by 1e-5, points of a plane span a tiny volume, so a single point has to count.
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(hull.add(Vec3(0.25 * i, 0, 0)));
  hull.add(Vec3(0, 1, 0));
  hull.add(Vec3(0, 0, 1));
  EXPECT_NEAR(hull.volume_m3(), 1.0 / 6, 1e-4);
}

TEST(SweepHull, IsEmptyAfterARestart) {
  SweepHull hull;
  grow_cube(hull);
  hull.restart(Vec3::Zero(), 1);
  EXPECT_EQ(hull.volume_m3(), 0);
  grow_cube(hull);
  EXPECT_NEAR(hull.volume_m3(), 1, 1e-4);
}

}  // namespace
}  // namespace sunder::fracture
