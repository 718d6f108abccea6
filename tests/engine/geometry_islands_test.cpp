// Tests of the islands of cut meshes, with holes and hollows.
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/mesh_islands.h"
#include "tests/engine/geometry_mesh_fixtures.h"

namespace sunder {
namespace {

using namespace test;

PolygonMesh cut(const PolygonMesh& mesh, const Plane& plane) {
  MeshClipScratch scratch;
  PolygonMesh result;
  const PlaneSide side = clip(mesh, plane, {2}, 0, result, scratch);
  return side == PlaneSide::kCut ? result : side == PlaneSide::kInside ? mesh : PolygonMesh{};
}

/// Returns one mesh of both, without merging vertices.
PolygonMesh concatenated(PolygonMesh a, const PolygonMesh& b) {
  const auto vertices = static_cast<std::uint32_t>(a.vertices.size());
  const auto contours = static_cast<std::uint32_t>(a.contours.size());
  const auto corners = static_cast<std::uint32_t>(a.corners.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const std::uint32_t v : b.corners) a.corners.push_back(vertices + v);
  a.corner_normals.insert(a.corner_normals.end(), b.corner_normals.begin(), b.corner_normals.end());
  for (PolygonMesh::Contour contour : b.contours) {
    contour.first_corner += corners;
    a.contours.push_back(contour);
  }
  for (PolygonMesh::Face face : b.faces) {
    face.first_contour += contours;
    a.faces.push_back(face);
  }
  return a;
}

TEST(Islands, AMeshInOnePartComesBackAsItWas) {
  for (const PolygonMesh& mesh : {comb(4), ring(), torus(12, 6)}) {
    const std::vector<PolygonMesh> parts = islands(mesh);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].corners, mesh.corners);
  }
  EXPECT_TRUE(islands({}).empty());
}

TEST(Islands, ACutCombGivesOneIslandPerTooth) {
  const PolygonMesh teeth = cut(comb(5), Plane{Vec3::UnitZ(), 0.1});
  const std::vector<PolygonMesh> parts = islands(teeth);
  ASSERT_EQ(parts.size(), 5u);
  for (const PolygonMesh& part : parts) {
    EXPECT_EQ(open_edges(part), 0u);
    EXPECT_EQ(part.faces.size(), 6u);
    EXPECT_NEAR(test::volume(part), 0.9 * 2 / 9, 1e-15);
  }
}

TEST(Islands, AHollowBelongsToTheSolidAroundIt) {
  EXPECT_EQ(islands(hollow_box()).size(), 1u);
  EXPECT_EQ(islands(cut(hollow_box(), Plane{Vec3::UnitX(), 0})).size(), 1u);
  const std::vector<PolygonMesh> parts =
      islands(concatenated(hollow_box(), polygon_mesh(cube(0.25))));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(test::volume(parts[0]), 7, 1e-14);
  EXPECT_NEAR(test::volume(parts[1]), 0.125, 1e-15);
}

TEST(Islands, AHollowThatTouchesASideBelongsToTheSolidAroundIt) {
  // The hollow is the cube of ±0.5 in that of ±1; one cut lies in a side of it.
  for (const double side : {-1.0, 1.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Plane in_side{side * Vec3::Unit(axis), -0.5};
      const PolygonMesh whole_hollow = cut(hollow_box(), in_side);
      ASSERT_EQ(islands(whole_hollow).size(), 1u) << axis;
      EXPECT_NEAR(test::volume(whole_hollow), 6 - 1, 1e-14);
      // The other cut goes through the hollow, which ends in the outline of the cap.
      const PolygonMesh half = cut(whole_hollow, Plane{Vec3::Unit((axis + 1) % 3), 0.4});
      ASSERT_EQ(islands(half).size(), 1u) << axis;
      EXPECT_NEAR(test::volume(half), 0.6 * 2 * 1.5 - 0.1, 1e-14);
    }
  }
}

TEST(Islands, ASolidInAHollowIsPartedFromItByACutThroughBoth) {
  const PolygonMesh nested = concatenated(hollow_box(), polygon_mesh(cube(0.25)));
  const PolygonMesh half = cut(nested, Plane{Vec3(0.6, 0.8, 0), 0});
  EXPECT_EQ(half.faces.back().contour_count, 3u);
  const std::vector<PolygonMesh> parts = islands(half);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(test::volume(parts[0]), 3.5, 1e-14);
  EXPECT_NEAR(test::volume(parts[1]), 0.0625, 1e-15);
}

RC_GTEST_PROP(Islands, AreWatertightConnectedAndSumToTheWhole, (std::uint64_t seed)) {
  Random random(seed);
  PolygonMesh mesh = random_mesh(random);
  for (int i = 0; i < 3; ++i) {
    PolygonMesh next = cut(mesh, random_plane(random, 0.6));
    if (!next.empty()) mesh = std::move(next);
  }
  const std::vector<PolygonMesh> parts = islands(mesh);
  double sum = 0;
  std::size_t corners = 0;
  for (const PolygonMesh& part : parts) {
    EXPECT_EQ(open_edges(part), 0u);
    EXPECT_EQ(part.corners.size(), part.corner_normals.size());
    EXPECT_GT(test::volume(part), 0);
    EXPECT_EQ(islands(part).size(), 1u);
    sum += test::volume(part);
    corners += part.corners.size();
  }
  EXPECT_NEAR(sum, test::volume(mesh), 1e-14);
  EXPECT_EQ(corners, mesh.corners.size());
}

}  // namespace
}  // namespace sunder
