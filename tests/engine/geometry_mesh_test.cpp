// Tests of clip() on meshes: pieces are watertight and their volumes sum to the whole.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/clip_mesh.h"
#include "tests/engine/geometry_mesh_fixtures.h"

namespace sunder::geometry_mesh_test {
namespace {

using namespace test;

struct MeshHalves {
  PolygonMesh inside, outside;
};

MeshHalves split(const PolygonMesh& mesh, const Plane& plane, double tolerance) {
  MeshClipScratch scratch;
  const auto side = [&](const Plane& p, PlaneId id) -> PolygonMesh {
    PolygonMesh result;
    const PlaneSide where = clip(mesh, p, id, tolerance, result, scratch);
    if (where == PlaneSide::kInside) return mesh;
    return where == PlaneSide::kCut ? result : PolygonMesh{};
  };
  return {side(plane, {2}), side(plane.flipped(), {3})};
}

void expect_sound(const PolygonMesh& mesh) {
  ASSERT_EQ(open_edges(mesh), 0u);
  ASSERT_EQ(mesh.corners.size(), mesh.corner_normals.size());
  for (const PolygonMesh::Contour& contour : mesh.contours) ASSERT_GE(contour.corner_count, 3u);
}

MeshHalves expect_halves(const PolygonMesh& mesh, const Plane& plane, double tolerance = 0) {
  MeshHalves halves = split(mesh, plane, tolerance);
  expect_sound(halves.inside);
  expect_sound(halves.outside);
  EXPECT_NEAR(volume(halves.inside) + volume(halves.outside), volume(mesh), 2e-14 + 20 * tolerance);
  return halves;
}

/// Returns the winding number of the surface around `point`.
double winding(const PolygonMesh& mesh, const Vec3& point) {
  double angle = 0;
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    const Vec3 a = mesh.vertices[corners[0]] - point;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 b = mesh.vertices[corners[i - 1]] - point;
      const Vec3 c = mesh.vertices[corners[i]] - point;
      const double x = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() +
                       c.dot(a) * b.norm();
      angle += 2 * std::atan2(a.dot(b.cross(c)), x);
    }
  }
  return angle / (4 * 3.14159265358979323846);
}

RC_GTEST_PROP(ClipMesh, RandomCutsGiveWatertightPiecesThatSumToTheWhole, (std::uint64_t seed)) {
  Random random(seed);
  const PolygonMesh mesh = random_mesh(random);
  expect_sound(mesh);
  expect_halves(mesh, random_plane(random, 0.8));
}

RC_GTEST_PROP(ClipMesh, RecursionLosesNothingAndCoversEveryPointOnce, (std::uint64_t seed)) {
  Random random(seed);
  const PolygonMesh whole = random_mesh(random);
  std::vector<PolygonMesh> pieces = {whole};
  for (int level = 0; level < 5; ++level) {
    std::vector<PolygonMesh> next;
    for (const PolygonMesh& piece : pieces) {
      MeshHalves halves = expect_halves(piece, random_plane(random, 0.7));
      if (!halves.inside.empty()) next.push_back(std::move(halves.inside));
      if (!halves.outside.empty()) next.push_back(std::move(halves.outside));
    }
    pieces = std::move(next);
  }
  double sum = 0;
  for (const PolygonMesh& piece : pieces) sum += volume(piece);
  EXPECT_NEAR(sum, volume(whole), 1e-13);
  for (int i = 0; i < 5; ++i) {
    const Vec3 point = random_point(random, 1.1);
    double windings = 0;
    for (const PolygonMesh& piece : pieces) {
      const double w = winding(piece, point);
      EXPECT_NEAR(w, std::round(w), 1e-6);
      EXPECT_GE(w, -1e-6);
      windings += w;
    }
    EXPECT_NEAR(windings, winding(whole, point), 1e-6);
  }
}

RC_GTEST_PROP(ClipMesh, PlanesThroughVerticesAndFacesHold, (std::uint64_t seed)) {
  Random random(seed);
  PolygonMesh mesh = random_mesh(random);
  for (int cut = 0; cut < 10; ++cut) {
    const auto vertex = [&] { return mesh.vertices[random.below(mesh.vertices.size())]; };
    const PolygonMesh::Face& face = mesh.faces[random.below(mesh.faces.size())];
    Plane plane = random.below(2) ? face.plane : face.plane.flipped();
    if (random.below(4) > 0) {
      const Vec3 a = vertex(), along = vertex() - a;
      const Vec3 normal = along.cross(random.below(2) ? random.direction() : vertex() - a);
      if (normal.norm() < 1e-6) continue;
      plane = Plane::through(a, normal.normalized());
    }
    const double tolerances[] = {0, 1e-13, 1e-9};
    MeshHalves halves = expect_halves(mesh, plane, tolerances[random.below(3)]);
    const bool keep_inside = halves.outside.empty() || (random.below(2) && !halves.inside.empty());
    mesh = keep_inside ? std::move(halves.inside) : std::move(halves.outside);
  }
}

RC_GTEST_PROP(ClipMesh, PlanesSnappedToAGridHold, (std::uint64_t seed)) {
  Random random(seed);
  PolygonMesh mesh = random_mesh(random);
  for (int cut = 0; cut < 8; ++cut) {
    const auto step = [&] { return static_cast<double>(random.below(5)) - 2; };
    const Vec3 direction(step(), step(), step());
    if (direction.isZero()) continue;
    const Plane plane = Plane::through(0.25 * Vec3(step(), step(), step()), direction.normalized());
    MeshHalves halves = expect_halves(mesh, plane, 1e-12);
    mesh = volume(halves.inside) > volume(halves.outside) ? std::move(halves.inside)
                                                          : std::move(halves.outside);
  }
}

RC_GTEST_PROP(ClipMesh, AConvexIsCutAsTheConvexClipperDoes, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron solid = random_solid(random, 1);
  const Plane plane = random_plane(random, 0.6);
  const Halves expected = test::split(solid, plane, 0);
  const MeshHalves halves = split(polygon_mesh(solid), plane, 0);
  EXPECT_NEAR(volume(halves.inside), test::volume(expected.inside), 1e-14);
  EXPECT_NEAR(volume(halves.outside), test::volume(expected.outside), 1e-14);
}

TEST(ClipMesh, ACombCutAcrossItsTeethHasOneCapOfManyContours) {
  const PolygonMesh half = split(comb(5), Plane{-Vec3::UnitZ(), -0.1}, 0).inside;
  const PolygonMesh::Face& cap = half.faces.back();
  EXPECT_EQ(cap.id, PlaneId{2});
  EXPECT_EQ(cap.kind, FaceKind::kInterior);
  EXPECT_EQ(cap.contour_count, 5u);
  EXPECT_NEAR(volume(half), 2 * 0.5 + 5 * (2.0 / 9) * 0.6, 1e-15);
}

TEST(ClipMesh, AHollowBoxGetsACapWithAHole) {
  const PolygonMesh half = split(hollow_box(), Plane{Vec3::UnitX(), -0.1}, 0).inside;
  EXPECT_EQ(half.faces.back().contour_count, 2u);
  EXPECT_NEAR(volume(half), 1.1 * 4 - 0.6, 1e-14);
}

TEST(ClipMesh, AFaceInThePlaneGoesWhollyToOneSide) {
  const MeshHalves at_top = split(ring(), Plane{Vec3::UnitY(), -1}, 0);
  EXPECT_EQ(at_top.inside.faces.size(), ring().faces.size());
  EXPECT_TRUE(at_top.outside.empty());
}

TEST(ClipMesh, TextureCoordinatesAndNormalsAreInterpolated) {
  PolygonMesh mesh = torus(24, 12);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const Vec3f p = mesh.vertices[mesh.corners[c]].cast<float>();
    mesh.corner_uvs.emplace_back(2 * p.x() + p.y(), p.z());
    mesh.corner_normals[c] = (p + Vec3f(0, 3, 0)).normalized();
  }
  Random random(11);
  const Plane plane = random_plane(random, 0.2);
  const PolygonMesh half = split(mesh, plane, 0).inside;
  ASSERT_EQ(half.corner_uvs.size(), half.corners.size());
  for (std::size_t f = 0; f + 1 < half.faces.size(); ++f) {
    const PolygonMesh::Contour& contour = half.contours[half.faces[f].first_contour];
    for (std::uint32_t i = 0; i < contour.corner_count; ++i) {
      const std::size_t c = contour.first_corner + i;
      const Vec3f p = half.vertices[half.corners[c]].cast<float>();
      EXPECT_NEAR((half.corner_uvs[c] - Vec2f(2 * p.x() + p.y(), p.z())).norm(), 0, 1e-5);
      EXPECT_NEAR((half.corner_normals[c] - (p + Vec3f(0, 3, 0)).normalized()).norm(), 0, 1e-2);
    }
  }
  const PolygonMesh::Contour& rim = half.contours[half.faces.back().first_contour];
  EXPECT_EQ(half.corner_normals[rim.first_corner], plane.normal.cast<float>());
}

TEST(PolygonMesh, OpenEdgesAreCounted) {
  PolygonMesh mesh = ring();
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(volume(mesh), 3, 1e-15);
  EXPECT_NEAR((mass_properties(mesh).centroid - Vec3(0, 0.5, 0)).norm(), 0, 1e-15);
  mesh.contours.pop_back();
  mesh.faces.pop_back();
  EXPECT_EQ(open_edges(mesh), 4u);
}

}  // namespace
}  // namespace sunder::geometry_mesh_test
