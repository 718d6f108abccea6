// Tests of the separating axis against a search over all faces and all pairs of edges.
#include "solver/rigid/collide/separation.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/base/rotation.h"
#include "engine/geometry/hull.h"

namespace sunder::solver {
namespace {

constexpr float kRounding_m = 1e-5f;  // Rounding error of distances for hulls of about a metre.

Hull random_hull(Random& random) {
  std::vector<Vec3> points;
  for (std::uint32_t i = 6 + random.below(14); i > 0; --i)
    points.push_back(random.uniform(0.3, 0.6) * random.direction());
  return Hull(make_hull(points), Vec3::Zero());
}

RelativePose random_pose(Random& random, double least_m, double most_m) {
  return {rotation_by(random.uniform(0, 3) * random.direction()).toRotationMatrix().cast<float>(),
          (random.uniform(least_m, most_m) * random.direction()).cast<float>()};
}

float gap_along(const Vec3f& axis, const Hull& a, const Hull& b, const RelativePose& pose) {
  float far_a = -1e30f, near_b = 1e30f;
  for (std::uint32_t v = 0; v < a.vertex_count(); ++v)
    far_a = std::max(far_a, axis.dot(a.vertex(v)));
  for (std::uint32_t v = 0; v < b.vertex_count(); ++v)
    near_b = std::min(near_b, axis.dot(pose.R * b.vertex(v) + pose.p));
  return near_b - far_a;
}

Vec3f along_edge(const Hull& hull, std::uint32_t e) {
  const auto [from, to] = hull.edge_vertices(e);
  return (hull.vertex(to) - hull.vertex(from)).normalized();
}

/// Returns the largest gap along any face normal and any cross product of edges.
float largest_gap(const Hull& a, const Hull& b, const RelativePose& pose) {
  float largest = -1e30f;
  const auto consider = [&](const Vec3f& axis) {
    largest = std::max(largest, gap_along(axis, a, b, pose));
  };
  for (std::uint32_t f = 0; f < a.face_count(); ++f) consider(a.normal(f));
  for (std::uint32_t f = 0; f < b.face_count(); ++f) consider(-(pose.R * b.normal(f)));
  for (std::uint32_t i = 0; i < a.edge_count(); ++i) {
    for (std::uint32_t j = 0; j < b.edge_count(); ++j) {
      const Vec3f axis = along_edge(a, i).cross(pose.R * along_edge(b, j));
      if (axis.norm() < 1e-3f) continue;
      consider(axis.normalized()), consider(-axis.normalized());
    }
  }
  return largest;
}

SeparatingAxis find_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                         const AxisReach& reach) {
  HullScratch scratch;
  place_in_each_other(a, b, pose, scratch);
  return separating_axis(a, b, pose, reach, 0, scratch);
}

TEST(SeparatingAxis, OfOverlappingHullsHasTheLargestSeparationOfAllAxes) {
  Random random(1);
  int overlaps = 0, edges = 0;
  for (int i = 0; i < 1500; ++i) {
    const Hull a = random_hull(random), b = random_hull(random);
    const RelativePose pose = random_pose(random, 0.3, 1.1);
    const float largest = largest_gap(a, b, pose);
    if (largest > 0) continue;
    ++overlaps;
    const SeparatingAxis axis = find_axis(a, b, pose, {1e30f, Vec3f::Zero()});
    EXPECT_NEAR(axis.separation_m, largest, kRounding_m);
    EXPECT_NEAR(gap_along(axis.normal_A, a, b, pose), axis.separation_m, kRounding_m);
    edges += axis.kind == SeparatingAxis::Kind::kEdges;
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_GT(edges, 100);
}

TEST(SeparatingAxis, OfDistantHullsHasAPositiveSeparation) {
  Random random(2);
  int apart = 0, edges = 0;
  for (int i = 0; i < 1500; ++i) {
    const Hull a = random_hull(random), b = random_hull(random);
    const RelativePose pose = random_pose(random, 0.7, 1.2);
    if (largest_gap(a, b, pose) < kRounding_m) continue;
    ++apart;
    const SeparatingAxis axis = find_axis(a, b, pose, {0, Vec3f::Zero()});
    EXPECT_GT(axis.separation_m, 0);
    EXPECT_NEAR(gap_along(axis.normal_A, a, b, pose), axis.separation_m, kRounding_m);
    EXPECT_NEAR(separation_along(axis.normal_A, a, b, pose), axis.separation_m, kRounding_m);
    edges += axis.kind == SeparatingAxis::Kind::kEdges;
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(edges, 20);
}

TEST(SeparatingAxis, OfPlatesWithCoplanarFacesIsTheFirstSeparatingFace) {
  const Hull plate(make_box(Vec3(-1, -0.1, -1), Vec3(1, 0.1, 1)), Vec3::Zero());
  const RelativePose pose = {Mat3f::Identity(), Vec3f(2.2f, 0, 2.2f)};
  const SeparatingAxis axis = find_axis(plate, plate, pose, {1e30f, Vec3f::Zero()});
  std::uint32_t first = 0;
  while (gap_along(plate.normal(first), plate, plate, pose) < 0.1f) ++first;
  EXPECT_EQ(axis.kind, SeparatingAxis::Kind::kFaceA);
  EXPECT_EQ(axis.index_a, first);
}

}  // namespace
}  // namespace sunder::solver
