// Tests of boxes, prisms, hulls and their mass properties against closed forms.
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/hull.h"
#include "tests/engine/geometry_fixtures.h"

namespace sunder::geometry_shapes_test {
namespace {

using namespace test;

RC_GTEST_PROP(MassProperties, ABoxHasTheClosedForm, (std::uint64_t seed)) {
  Random random(seed);
  const Vec3 min = random_point(random, 2);
  const Vec3 size(random.uniform(0.1, 3), random.uniform(0.1, 3), random.uniform(0.1, 3));
  const MassProperties solid = mass_properties(make_box(min, min + size));
  EXPECT_NEAR(solid.volume_m3 / size.prod(), 1, 4e-15);
  EXPECT_NEAR((solid.centroid - (min + 0.5 * size)).norm(), 0, 4e-15);
  const Mat3 expected = (size.prod() / 12 * size.cwiseAbs2()).asDiagonal();
  EXPECT_NEAR((solid.second_moment - expected).norm() / expected.norm(), 0, 1e-14);
  const double about_x = size.prod() / 12 * (size.y() * size.y() + size.z() * size.z());
  EXPECT_NEAR(solid.inertia()(0, 0) / about_x, 1, 1e-13);
}

TEST(MassProperties, ARegularPrismHasTheClosedForm) {
  const int sides = 7;
  const double r = 1.3, height = 2.5, turn = 2 * 3.14159265358979323846 / sides;
  const SinCos at = sin_cos(turn);
  const double area = 0.5 * sides * r * r * at.sin;
  const MassProperties solid =
      mass_properties(make_prism(regular_polygon(sides, r), 1, 1 + height, false));
  EXPECT_NEAR(solid.volume_m3, area * height, 1e-14);
  EXPECT_NEAR((solid.centroid - Vec3(0, 1 + height / 2, 0)).norm(), 0, 1e-14);
  // Second moment of area of a regular polygon about an axis in its plane.
  const double across = area * r * r / 12 * (2 + at.cos);
  EXPECT_NEAR(solid.second_moment(0, 0), across * height, 1e-13);
  EXPECT_NEAR(solid.second_moment(1, 1), area * height * height * height / 12, 1e-13);
  EXPECT_NEAR(solid.second_moment(0, 2), 0, 1e-14);
}

TEST(MassProperties, ACornerTetrahedronHasTheClosedForm) {
  const MassProperties solid = mass_properties(
      make_hull(std::vector<Vec3>{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}));
  EXPECT_NEAR(solid.volume_m3, 1.0 / 6, 1e-16);
  EXPECT_NEAR((solid.centroid - Vec3::Constant(0.25)).norm(), 0, 1e-15);
  EXPECT_NEAR(solid.second_moment(0, 0), 1.0 / 60 - 1.0 / 96, 1e-16);
  EXPECT_NEAR(solid.second_moment(0, 1), 1.0 / 120 - 1.0 / 96, 1e-16);
}

RC_GTEST_PROP(MassProperties, PiecesSumToTheWhole, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron solid = random_solid(random, 1);
  const Halves halves = split(solid, random_plane(random, 0.6), 0);
  const MassProperties whole = mass_properties(solid);
  const MassProperties sum = mass_properties(halves.inside) + mass_properties(halves.outside);
  EXPECT_NEAR(sum.volume_m3, whole.volume_m3, 1e-14);
  EXPECT_NEAR((sum.centroid - whole.centroid).norm() * whole.volume_m3, 0, 1e-14);
  EXPECT_NEAR((sum.second_moment - whole.second_moment).norm(), 0, 1e-13);
}

RC_GTEST_PROP(MassProperties, MovingASolidMovesItsMass, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron solid = random_solid(random, 1);
  const Pose pose = random_pose(random, 2);
  const ConvexPolyhedron placed = transformed(solid, pose);
  EXPECT_TRUE(is_convex(placed, 1e-13));
  const MassProperties before = mass_properties(solid), after = mass_properties(placed);
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-13);
  EXPECT_NEAR((after.centroid - pose * before.centroid).norm(), 0, 1e-13);
  const Mat3 turn = pose.rotation.toRotationMatrix();
  EXPECT_NEAR((after.second_moment - turn * before.second_moment * turn.transpose()).norm(), 0,
              1e-13);
}

TEST(Shapes, ABoxIsClosedAndItsPlanesAreExact) {
  const Vec3 min(-1, 2, 3), max(0.1, 2.3, 7);
  const ConvexPolyhedron box = make_box(min, max);
  EXPECT_TRUE(is_closed(box));
  EXPECT_TRUE(is_convex(box, 0));
  EXPECT_EQ(bounds(box).min, min);
  EXPECT_EQ(bounds(box).max, max);
  const Vec3 size = max - min;
  EXPECT_DOUBLE_EQ(face_area(box, 0), size.y() * size.z());
}

TEST(Shapes, ASmoothPrismIsShadedRound) {
  const ConvexPolyhedron column = make_prism(regular_polygon(32, 2), 0, 3, true);
  EXPECT_TRUE(is_closed(column));
  for (std::size_t f = 2; f < column.faces.size(); ++f) {
    for (std::uint32_t c = 0; c < 4; ++c) {
      const std::size_t corner = column.faces[f].first_corner + c;
      Vec3 radial = column.vertices[column.corners[corner]];
      radial.y() = 0;
      EXPECT_NEAR((column.corner_normals[corner].cast<double>() - radial / 2).norm(), 0, 1e-6);
    }
  }
}

TEST(Shapes, AnOpenOrPinchedSurfaceIsNotClosed) {
  ConvexPolyhedron box = cube(1);
  box.faces.pop_back();
  EXPECT_FALSE(is_closed(box));
  box = cube(1);
  box.vertices.push_back(Vec3::Zero());
  EXPECT_FALSE(is_closed(box));
  box = cube(1);
  box.corners[1] = box.corners[0];
  EXPECT_FALSE(is_closed(box));
}

void expect_hull(std::span<const Vec3> points, const ConvexPolyhedron& hull, double size) {
  ASSERT_TRUE(is_closed(hull));
  EXPECT_TRUE(is_convex(hull, 1e-9 * size));
  for (const ConvexPolyhedron::Face& face : hull.faces) {
    for (const Vec3& p : points) EXPECT_LE(face.plane.distance(p), 1e-9 * size);
  }
}

RC_GTEST_PROP(Hull, EnclosesRandomPoints, (std::uint64_t seed)) {
  Random random(seed);
  const double size = std::pow(10.0, random.uniform(-6, 6));
  std::vector<Vec3> points(4 + random.below(200));
  for (Vec3& p : points) p = size * random.direction();
  const ConvexPolyhedron hull = make_hull(points);
  expect_hull(points, hull, size);
  EXPECT_EQ(hull.vertices.size(), points.size());
}

RC_GTEST_PROP(Hull, OfGridPointsHasMergedFaces, (std::uint64_t seed)) {
  Random random(seed);
  std::vector<Vec3> points;
  for (std::uint32_t i = 0, n = 4 + random.below(60); i < n; ++i) {
    points.emplace_back(random.below(4), random.below(4), random.below(4));
  }
  const ConvexPolyhedron hull = make_hull(points);
  if (hull.empty()) return;
  expect_hull(points, hull, 1);
  for (std::size_t a = 0; a < hull.faces.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Plane &p = hull.faces[a].plane, &q = hull.faces[b].plane;
      EXPECT_FALSE((p.normal - q.normal).norm() < 1e-9 && std::abs(p.d - q.d) < 1e-9);
    }
  }
}

RC_GTEST_PROP(Hull, OfATurnedFilledBoxIsTheBox, (std::uint64_t seed)) {
  Random random(seed);
  const Pose pose = random_pose(random, 3);
  const Vec3 size(1, random.uniform(0.001, 1), random.uniform(0.01, 1));
  std::vector<Vec3> points;
  for (int i = 0; i < 64; ++i) {  // corners, edge, face and inner points; then duplicates
    points.push_back(pose * Vec3(size.cwiseProduct(Vec3(i % 4, i / 4 % 4, i / 16))));
  }
  points.insert(points.end(), points.begin(), points.begin() + 30);
  const ConvexPolyhedron hull = make_hull(points);
  expect_hull(points, hull, 3);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_EQ(hull.faces.size(), 6u);
  EXPECT_NEAR(volume(hull) / (27 * size.prod()), 1, 1e-11);
}

TEST(Hull, OfNoisyGridPointsEnclosesThem) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {  // noise about as large as the tolerance, too
    Random random(seed);
    const double noise = std::pow(10.0, random.uniform(-16, -6));
    const double z_m = random.uniform(0.1, 1), y_m = random.uniform(0.01, 1);
    const Vec3 size(1, y_m, z_m);
    const Pose pose = random_pose(random, 10);
    std::vector<Vec3> points(4 + random.below(60));
    for (Vec3& p : points) {
      const auto z = random.below(3), y = random.below(3), x = random.below(3);
      const Vec3 grid(x, y, z);
      p = pose * size.cwiseProduct(grid + noise * random_point(random, random.below(2)));
    }
    const ConvexPolyhedron hull = make_hull(points);
    if (!hull.empty()) expect_hull(points, hull, 10);
  }
}

TEST(Hull, OfPointsInAPlaneIsEmpty) {
  std::vector<Vec3> points;
  EXPECT_TRUE(make_hull(points).empty());
  Random random(3);
  const Pose pose = random_pose(random, 5);
  for (int i = 0; i < 50; ++i) {
    points.push_back(pose * Vec3(random.uniform(), random.uniform(), 0));
    EXPECT_TRUE(make_hull(points).empty());
  }
  EXPECT_TRUE(make_hull(std::vector<Vec3>(10, Vec3(1, 2, 3))).empty());
}

}  // namespace
}  // namespace sunder::geometry_shapes_test
