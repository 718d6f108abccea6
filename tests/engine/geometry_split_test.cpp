// Tests of split(): a mesh cut to many regions at once equals the mesh cut to each region alone.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/split_mesh.h"
#include "tests/engine/geometry_mesh_fixtures.h"

namespace sunder::geometry_split_test {
namespace {

using namespace test;

/// Regions and the storage of the planes that they refer to.
struct Regions {
  std::vector<std::vector<NamedPlane>> planes;
  std::vector<MeshRegion> regions;

  void add(const Box& box, std::vector<NamedPlane> bounding) {
    planes.push_back(std::move(bounding));
    regions.push_back({box, {}});
  }
  std::span<const MeshRegion> get() {
    for (std::size_t r = 0; r < regions.size(); ++r) regions[r].planes = planes[r];
    return regions;
  }
};

const Box kEverywhere{Vec3::Constant(-std::numeric_limits<double>::infinity()),
                      Vec3::Constant(std::numeric_limits<double>::infinity())};

/// Returns the Voronoi cells of random sites; if `boxed`, with their bounds within [-2, 2]³.
Regions voronoi(Random& random, std::uint64_t cells, bool boxed) {
  std::vector<Vec3> sites(cells);
  for (Vec3& site : sites) site = random_point(random, 1);
  Regions regions;
  ClipScratch scratch;
  ConvexPolyhedron next;
  for (std::uint64_t i = 0; i < cells; ++i) {
    std::vector<NamedPlane> planes;
    ConvexPolyhedron cell = cube(2);
    for (std::uint64_t j = 0; j < cells; ++j) {
      if (i == j) continue;
      const std::uint64_t low = std::min(i, j), high = std::max(i, j);
      const Plane plane =
          Plane::through(0.5 * (sites[low] + sites[high]), (sites[high] - sites[low]).normalized());
      const PlaneId id{2 * (low * cells + high + 1)};
      planes.push_back(i < j ? NamedPlane{plane, id} : NamedPlane{plane.flipped(), id.opposite()});
      if (clip(cell, planes.back().plane, id, 0, next, scratch) == PlaneSide::kCut) {
        std::swap(cell, next);
      }
    }
    regions.add(boxed ? bounds(cell) : kEverywhere, planes);
  }
  return regions;
}

/// Returns count³ equal cubes that fill [-1, 1]³, with faces in shared planes.
Regions bricks(int count) {
  Regions regions;
  const double side = 2.0 / count;
  for (int i = 0; i < count * count * count; ++i) {
    const Eigen::Vector3i at(i % count, i / count % count, i / count / count);
    Box box;
    box.min = side * at.cast<double>() - Vec3::Ones();
    box.max = side * (at + Eigen::Vector3i::Ones()).cast<double>() - Vec3::Ones();
    std::vector<NamedPlane> planes;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 up = Vec3::Unit(axis);
      const auto id = [&](int step) {
        return PlaneId{2 * static_cast<std::uint64_t>(100 * axis + step + 1)};
      };
      if (at[axis] > 0) planes.push_back({Plane{-up, box.min[axis]}, id(at[axis]).opposite()});
      if (at[axis] + 1 < count) planes.push_back({Plane{up, -box.max[axis]}, id(at[axis] + 1)});
    }
    regions.add(box, planes);
  }
  return regions;
}

void expect_whole(const PolygonMesh& mesh, std::span<const PolygonMesh> parts) {
  double sum = 0;
  for (const PolygonMesh& part : parts) {
    ASSERT_EQ(open_edges(part), 0u);
    sum += test::volume(part);
  }
  EXPECT_NEAR(sum, test::volume(mesh), 1e-13);
}

RC_GTEST_PROP(SplitMesh, PartsAreThoseOfCuttingByEachRegionAlone, (std::uint64_t seed)) {
  Random random(seed);
  const PolygonMesh mesh = random_mesh(random);
  Regions cells = voronoi(random, 1 + random.below(30), random.below(2) == 0);
  const std::vector<PolygonMesh> parts = split(mesh, cells.get(), 0);
  ASSERT_EQ(parts.size(), cells.regions.size());
  expect_whole(mesh, parts);
  MeshClipScratch scratch;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    PolygonMesh alone = mesh, next;
    for (const auto& [plane, id] : cells.planes[r]) {
      const PlaneSide side = clip(alone, plane, id, 0, next, scratch);
      if (side == PlaneSide::kOutside) alone = {};
      if (side == PlaneSide::kCut) std::swap(alone, next);
    }
    EXPECT_NEAR(test::volume(parts[r]), test::volume(alone), 1e-14);
    for (const PolygonMesh::Face& face : parts[r].faces) {
      EXPECT_EQ(face.kind == FaceKind::kInterior, !face.id.none());
    }
  }
}

TEST(SplitMesh, BricksFlushWithTheMeshMakeUpTheWhole) {
  for (const int count : {2, 3, 4}) {
    for (const PolygonMesh& mesh : {comb(4), ring(), hollow_box(), torus(16, 8)}) {
      Regions regions = bricks(count);
      expect_whole(mesh, split(mesh, regions.get(), 1e-9));
    }
  }
}

TEST(SplitMesh, TheNumberOfThreadsMakesNoDifference) {
  Random random(5);
  const PolygonMesh mesh = torus(60, 30);
  Regions cells = voronoi(random, 40, true);
  set_threads(1);
  const std::vector<PolygonMesh> expected = split(mesh, cells.get(), 0);
  set_threads(4);
  const std::vector<PolygonMesh> parts = split(mesh, cells.get(), 0);
  set_threads(0);
  for (std::size_t r = 0; r < parts.size(); ++r) {
    EXPECT_EQ(parts[r].vertices, expected[r].vertices);
    EXPECT_EQ(parts[r].corners, expected[r].corners);
  }
}

TEST(SplitMesh, RegionsThatMissLeaveNothingAndOneThatCoversLeavesAll) {
  const PolygonMesh mesh = ring();
  const std::vector<NamedPlane> none, away = {{Plane{Vec3::UnitX(), 5}, PlaneId{2}}};
  const std::vector<MeshRegion> regions = {{kEverywhere, none}, {kEverywhere, away}};
  const std::vector<PolygonMesh> parts = split(mesh, regions, 0);
  EXPECT_EQ(parts[0].vertices, mesh.vertices);
  EXPECT_TRUE(parts[1].empty());
  EXPECT_TRUE(split(mesh, {}, 0).empty());
}

}  // namespace
}  // namespace sunder::geometry_split_test
