// Casts and overlaps of single shapes, against distances and dense sampling.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/base/random.h"
#include "engine/geometry/cast.h"
#include "engine/geometry/hull.h"

namespace sunder {
namespace {

Vec3 point_in(Random& random, double half_m) {
  return {random.uniform(-half_m, half_m), random.uniform(-half_m, half_m),
          random.uniform(-half_m, half_m)};
}

ConvexPolyhedron random_hull(Random& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < 12; ++i) points.push_back(point_in(random, 1));
  return make_hull(points);
}

/// Returns the distance from a point to a convex by alternating projections onto its half-spaces
/// (Dykstra), which shares nothing with distance().
double distance_by_projections(const ConvexPolyhedron& convex, const Vec3& point) {
  Vec3 x = point;
  std::vector<Vec3> offsets(convex.faces.size(), Vec3::Zero());
  for (int round = 0; round < 4000; ++round) {
    for (std::size_t f = 0; f < convex.faces.size(); ++f) {
      const Vec3 y = x + offsets[f];
      x = y - std::max(0.0, convex.faces[f].plane.distance(y)) * convex.faces[f].plane.normal;
      offsets[f] = y - x;
    }
  }
  return (x - point).norm();
}

RC_GTEST_PROP(Cast, DistanceIsThatOfTheProjection, (std::uint64_t seed)) {
  Random random(seed, 0);
  const ConvexPolyhedron convex = random_hull(random);
  const Vec3 point = point_in(random, 3);
  const double distance_m = distance(convex, point);
  RC_ASSERT(std::abs(distance_m - distance_by_projections(convex, point)) < 1e-3);
  for (const double radius_m : {0.0, 0.5 * distance_m, 1.001 * distance_m, 9.0})
    RC_ASSERT(is_within(convex, point, radius_m) == (distance_m <= radius_m));
}

/// Checks a hit, or a miss, against the distance of the ball's centre along its way.
template <class DistanceTo>
void check_cast(const MovingBall& ball, const std::optional<SurfaceHit>& hit,
                const DistanceTo& distance_to) {
  const double end_m = hit ? hit->distance_m : ball.reach_m;
  for (int i = 0; i < 200; ++i) {  // nothing is met before
    const double at_m = end_m * i / 200;
    if (hit && hit->distance_m == 0) break;
    RC_ASSERT(distance_to(ball.from + at_m * ball.direction) > ball.radius_m - 1e-9);
  }
  if (!hit) return;
  const double gap_m = distance_to(ball.from + hit->distance_m * ball.direction) - ball.radius_m;
  if (hit->distance_m == 0) {
    RC_ASSERT(gap_m <= 1e-9);
  } else {
    RC_ASSERT(std::abs(gap_m) < 1e-9);
    RC_ASSERT(hit->normal.dot(ball.direction) < 1e-9);
    RC_ASSERT(std::abs(hit->normal.norm() - 1) < 1e-9);
  }
}

RC_GTEST_PROP(Cast, TheFirstPointIsOnTheSurfaceAndNothingIsMetBefore, (std::uint64_t seed)) {
  Random random(seed, 0);
  const ConvexPolyhedron convex = random_hull(random);
  for (const double radius_m : {0.0, 0.05, 0.7}) {
    MovingBall ball{point_in(random, 3), random.direction(), random.uniform(0, 6), radius_m};
    if (random.uniform(0, 1) < 0.5)
      ball.direction = (0.4 * point_in(random, 1) - ball.from).normalized();
    if (radius_m == 0 && distance(convex, ball.from) == 0) continue;
    check_cast(ball, cast(ball, convex), [&](const Vec3& p) { return distance(convex, p); });
    const Vec3 center = point_in(random, 1);
    check_cast(ball, cast_at_ball(ball, center, 0.4),
               [&](const Vec3& p) { return std::max(0.0, (p - center).norm() - 0.4); });
    const Plane plane = Plane::through(point_in(random, 1), random.direction());
    check_cast(ball, cast(ball, plane),
               [&](const Vec3& p) { return std::max(0.0, plane.distance(p)); });
  }
}

TEST(Cast, AStartInsideIsAHitAtZeroAgainstTheMotion) {
  const ConvexPolyhedron box = make_box(Vec3::Constant(-1), Vec3::Constant(1));
  for (const double radius_m : {0.0, 0.3}) {
    const std::optional<SurfaceHit> hit = cast({Vec3(0.5, 0, 0), Vec3::UnitX(), 9, radius_m}, box);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->distance_m, 0);
    EXPECT_EQ(hit->normal, Vec3(-Vec3::UnitX()));
  }
}

TEST(Cast, ABallMeetsFaceEdgeAndCornerOfABox) {
  const ConvexPolyhedron box = make_box(Vec3::Constant(-1), Vec3::Constant(1));
  const double r = 0.5;
  const Vec3 down = -Vec3::UnitY();
  EXPECT_NEAR(cast({Vec3(0, 5, 0), down, 9, r}, box)->distance_m, 4 - r, 1e-12);
  // 0.3 beyond an edge, and 0.3 beyond both edges at a corner.
  EXPECT_NEAR(cast({Vec3(1.3, 5, 0), down, 9, r}, box)->distance_m, 4 - std::sqrt(r * r - 0.09),
              1e-12);
  EXPECT_NEAR(cast({Vec3(1.3, 5, 1.3), down, 9, r}, box)->distance_m, 4 - std::sqrt(r * r - 0.18),
              1e-12);
  EXPECT_FALSE(cast({Vec3(1.51, 5, 0), down, 9, r}, box));
  EXPECT_FALSE(cast({Vec3(0, 5, 0), down, 3.49, r}, box)) << "beyond the reach";
  EXPECT_TRUE(cast({Vec3(0, 5, 0), down, 3.51, r}, box));
}

TEST(Cast, ATriangleOfTheGroundStopsOnlyWhatComesFromItsFront) {
  const std::array<Vec3, 3> up = {Vec3(-1, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, -1)};
  EXPECT_NEAR(cast_at_front({Vec3(0, 2, 0), -Vec3::UnitY(), 9, 0}, up)->distance_m, 2, 1e-12);
  EXPECT_NEAR(cast_at_front({Vec3(0, 2, 0), -Vec3::UnitY(), 9, 0.5}, up)->distance_m, 1.5, 1e-12);
  EXPECT_FALSE(cast_at_front({Vec3(0, -2, 0), Vec3::UnitY(), 9, 0}, up));
  EXPECT_FALSE(cast_at_front({Vec3(0, 2, 1.1), -Vec3::UnitY(), 9, 0}, up));
}

RC_GTEST_PROP(Cast, ABoxOverlapsIfSomePointIsInBoth, (std::uint64_t seed)) {
  Random random(seed, 0);
  const ConvexPolyhedron convex = random_hull(random);
  const Pose X_QC{point_in(random, 1.5),
                  Quat(Eigen::AngleAxisd(random.uniform(0, 3), random.direction()))};
  Box box;
  box.extend(point_in(random, 1.5));
  box.extend(point_in(random, 1.5));
  bool common = false;
  const Pose X_CQ = X_QC.inverse();
  for (int i = 0; i < 2000 && !common; ++i) {
    const Vec3 share(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    common = distance(convex, X_CQ * Vec3(box.min + share.cwiseProduct(box.extent()))) == 0;
  }
  if (common) RC_ASSERT(overlaps(convex, X_QC, box));
  // Shrunk by what separates them, a convex that does not overlap stays apart from its own box.
  if (!overlaps(convex, X_QC, box)) {
    for (const Vec3& vertex : convex.vertices) RC_ASSERT(distance(box, X_QC * vertex) > 0);
  }
}

}  // namespace
}  // namespace sunder
