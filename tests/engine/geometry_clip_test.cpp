// Tests of clip() on convexes: for any plane, pieces are closed and their volumes sum to the whole.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/clip.h"
#include "tests/engine/geometry_fixtures.h"

namespace sunder {
namespace {

using namespace test;

void expect_sound(const ConvexPolyhedron& piece, double size) {
  if (piece.empty()) return;
  ASSERT_TRUE(is_closed(piece));
  ASSERT_EQ(piece.corners.size(), piece.corner_normals.size());
  EXPECT_GT(volume(piece), -1e-15 * size * size * size);
  EXPECT_TRUE(is_convex(piece, 1e-13 * size));
}

/// Cuts `solid` and expects closed pieces whose volumes sum to its volume.
Halves expect_halves(const ConvexPolyhedron& solid, const Plane& plane, double size,
                     double tolerance = 0) {
  Halves halves = split(solid, plane, tolerance);
  expect_sound(halves.inside, size);
  expect_sound(halves.outside, size);
  const double whole = volume(solid);
  // Reused vertices lie off the plane by up to the tolerance, and a cap's area is below 12 size².
  EXPECT_NEAR(volume(halves.inside) + volume(halves.outside), whole,
              2e-14 * size * size * size + 12 * tolerance * size * size);
  return halves;
}

RC_GTEST_PROP(Clip, RandomCutsGiveClosedPiecesThatSumToTheWhole, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron solid = random_solid(random, 1);
  expect_halves(solid, random_plane(random, 0.8), 1);
}

RC_GTEST_PROP(Clip, SizeMakesNoDifference, (std::uint64_t seed)) {
  Random random(seed);
  const double size = std::pow(10.0, random.uniform(-6, 6));
  expect_halves(random_solid(random, size), random_plane(random, 0.8 * size), size);
}

RC_GTEST_PROP(Clip, SixWayRecursionLosesNothing, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron whole = random_solid(random, 1);
  std::vector<ConvexPolyhedron> pieces = {whole};
  for (int level = 0; level < 6; ++level) {
    std::vector<ConvexPolyhedron> next;
    for (const ConvexPolyhedron& piece : pieces) {
      const Vec3 inside = mass_properties(piece).centroid + 0.1 * random_point(random, 0.5);
      Halves halves = expect_halves(piece, Plane::through(inside, random.direction()), 1);
      if (!halves.inside.empty()) next.push_back(std::move(halves.inside));
      if (!halves.outside.empty()) next.push_back(std::move(halves.outside));
    }
    pieces = std::move(next);
  }
  double sum = 0;
  for (const ConvexPolyhedron& piece : pieces) sum += volume(piece);
  EXPECT_NEAR(sum, volume(whole), 1e-14);
}

RC_GTEST_PROP(Clip, PlanesThroughVerticesEdgesAndFacesHold, (std::uint64_t seed)) {
  Random random(seed);
  ConvexPolyhedron solid = random_solid(random, 1);
  for (int cut = 0; cut < 12 && !solid.empty(); ++cut) {
    const auto vertex = [&] { return solid.vertices[random.below(solid.vertices.size())]; };
    const ConvexPolyhedron::Face& face = solid.faces[random.below(solid.faces.size())];
    Plane plane = random.below(2) ? face.plane : face.plane.flipped();
    if (random.below(4) > 0) {
      const Vec3 a = vertex(), along = vertex() - a;
      Vec3 normal = random.direction();
      if (random.below(3) > 0) normal = along.cross(normal);
      if (random.below(3) > 0) normal = along.cross(vertex() - a);
      if (normal.norm() < 1e-9) continue;
      plane = Plane::through(a, normal.normalized());
    }
    Halves halves = expect_halves(solid, plane, 1, random.below(2) ? 1e-13 : 0.0);
    const bool keep_inside = halves.outside.empty() || random.below(2);
    solid = keep_inside ? std::move(halves.inside) : std::move(halves.outside);
    if (volume(solid) < 1e-6) break;
  }
}

RC_GTEST_PROP(Clip, PlanesSnappedToAGridHold, (std::uint64_t seed)) {
  Random random(seed);
  std::vector<ConvexPolyhedron> pieces = {cube(1)};
  for (int cut = 0; cut < 8; ++cut) {
    const auto step = [&] { return static_cast<double>(random.below(5)) - 2; };
    const Vec3 direction(step(), step(), step());
    if (direction.isZero()) continue;
    const Vec3 through(0.5 * step(), 0.5 * step(), 0.5 * step());
    const Plane plane = Plane::through(through, direction.normalized());
    std::vector<ConvexPolyhedron> next;
    for (const ConvexPolyhedron& piece : pieces) {
      Halves halves = expect_halves(piece, plane, 1, 1e-12);
      if (!halves.inside.empty()) next.push_back(std::move(halves.inside));
      if (!halves.outside.empty()) next.push_back(std::move(halves.outside));
    }
    pieces = std::move(next);
  }
  double sum = 0;
  for (const ConvexPolyhedron& piece : pieces) sum += volume(piece);
  EXPECT_NEAR(sum, 8, 1e-11);
}

RC_GTEST_PROP(Clip, BothSidesOfACutShareTheirVerticesBitForBit, (std::uint64_t seed)) {
  Random random(seed);
  const ConvexPolyhedron solid = random_solid(random, 1);
  const Halves halves = split(solid, random_plane(random, 0.5), 0);
  if (halves.inside.empty() || halves.outside.empty()) return;
  const auto cap = [](const ConvexPolyhedron& piece) {
    std::vector<std::array<double, 3>> points;
    for (const std::uint32_t v : piece.face_corners(piece.faces.size() - 1)) {
      const Vec3& p = piece.vertices[v];
      points.push_back({p.x(), p.y(), p.z()});
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  EXPECT_EQ(cap(halves.inside), cap(halves.outside));
}

TEST(Clip, APlaneThatMissesLeavesTheConvexUntouched) {
  ClipScratch scratch;
  ConvexPolyhedron result;
  const ConvexPolyhedron box = cube(1);
  const Plane above = Plane::through(Vec3(0, 2, 0), Vec3::UnitY());
  EXPECT_EQ(clip(box, above, {2}, 0, result, scratch), PlaneSide::kInside);
  EXPECT_EQ(clip(box, above.flipped(), {3}, 0, result, scratch), PlaneSide::kOutside);
  const Plane face = Plane::through(Vec3(0, 1, 0), Vec3::UnitY());
  EXPECT_EQ(clip(box, face, {2}, 0, result, scratch), PlaneSide::kInside);
  EXPECT_EQ(clip(box, face.flipped(), {3}, 0, result, scratch), PlaneSide::kOutside);
  const Plane corner = Plane::through(Vec3(1, 1, 1), Vec3(1, 1, 1).normalized());
  EXPECT_EQ(clip(box, corner, {2}, 1e-12, result, scratch), PlaneSide::kInside);
}

TEST(Clip, AConvexThinnerThanTheToleranceIsOnExactlyOneSide) {
  for (const double lift : {-1e-10, 0.0, 1e-10}) {
    const ConvexPolyhedron sheet = make_box(Vec3(-1, lift - 1e-9, -1), Vec3(1, lift + 1e-9, 1));
    const Halves halves = split(sheet, Plane{Vec3::UnitY(), 0}, 1e-8);
    EXPECT_NE(halves.inside.empty(), halves.outside.empty());
  }
}

TEST(Clip, TheNewFaceIsNamedFlatAndInterior) {
  const Plane plane = Plane::through(Vec3(0.2, 0.1, 0), Vec3(1, 2, 3).normalized());
  const ConvexPolyhedron half = split(cube(1), plane, 0).inside;
  const ConvexPolyhedron::Face& cap = half.faces.back();
  EXPECT_EQ(cap.id, PlaneId{2});
  EXPECT_EQ(cap.kind, FaceKind::kInterior);
  EXPECT_EQ(cap.plane.normal, plane.normal);
  for (std::uint32_t c = 0; c < cap.corner_count; ++c) {
    EXPECT_EQ(half.corner_normals[cap.first_corner + c], plane.normal.cast<float>());
  }
  for (std::size_t f = 0; f + 1 < half.faces.size(); ++f) {
    EXPECT_EQ(half.faces[f].kind, FaceKind::kSurface);
    EXPECT_TRUE(half.faces[f].id.none());
  }
}

TEST(Clip, CornerNormalsAreInterpolatedAlongCutEdges) {
  const ConvexPolyhedron column = make_prism(regular_polygon(8, 1), -1, 1, true);
  const ConvexPolyhedron half = split(column, Plane{Vec3::UnitZ(), -0.1}, 0).inside;
  int checked = 0;
  for (std::size_t f = 0; f + 1 < half.faces.size(); ++f) {
    const ConvexPolyhedron::Face& face = half.faces[f];
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      EXPECT_NEAR(half.corner_normals[c].norm(), 1, 1e-6);
      const Vec3& v = half.vertices[half.corners[c]];
      if (std::abs(v.z() - 0.1) > 1e-12 || std::abs(face.plane.normal.y()) > 0.5) continue;
      // The vertex is on the facet between the corners at 0 and 45°, whose normals are radial.
      const double corner_z = std::sqrt(0.5), t = 0.1 / corner_z;
      const Vec3 start(v.x() > 0 ? 1 : -1, 0, 0), end(start.x() * corner_z, 0, corner_z);
      const Vec3 expected = ((1 - t) * start + t * end).normalized();
      EXPECT_NEAR((half.corner_normals[c].cast<double>() - expected).norm(), 0, 1e-6);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 4);
}

}  // namespace
}  // namespace sunder
