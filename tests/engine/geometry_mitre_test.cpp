// Tests of mitres: at any bend, both sides are closed, end in one plane, and keep their volume.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/base/rotation.h"
#include "engine/geometry/mitre.h"
#include "tests/engine/bent_bar.h"

namespace sunder::geometry_mitre_test {
namespace {

using namespace test;

double angle_between(const Vec3& a, const Vec3& b) {
  return arc_tangent(a.cross(b).norm(), a.dot(b));
}

void expect_sound(const Side& side) {
  for (const auto& column : side.columns) {
    for (const ConvexPolyhedron& convex : column) {
      ASSERT_TRUE(is_closed(convex));
      ASSERT_EQ(convex.corners.size(), convex.corner_normals.size());
      EXPECT_GT(volume(convex), 0);
      EXPECT_TRUE(is_convex(convex, 4 * kTolerance));
    }
  }
}

/// Expects that each face lies, bit for bit, in the midplane or in a plane of the straight side.
void expect_old_planes(const Side& straight, const Side& bent, const Plane& midplane) {
  std::map<PlaneId, Plane> planes;
  for (const auto& column : straight.columns) {
    for (const ConvexPolyhedron& convex : column) {
      for (const ConvexPolyhedron::Face& face : convex.faces) planes[face.id] = face.plane;
    }
  }
  planes.erase(straight.section);
  planes[bent.section] = midplane;
  for (const auto& column : bent.columns) {
    for (const ConvexPolyhedron& convex : column) {
      for (const ConvexPolyhedron::Face& face : convex.faces) {
        ASSERT_EQ(planes.count(face.id), 1u);
        EXPECT_EQ(planes[face.id].normal, face.plane.normal);
        EXPECT_EQ(planes[face.id].d, face.plane.d);
        EXPECT_EQ(face.kind, face.id == bent.section ? FaceKind::kInterior : FaceKind::kSurface);
      }
    }
  }
}

/// Expects that both sections are one polygon in space.
void expect_same_outline(const Side& a, const Side& b, const Pose& X_AB) {
  for (int i = 0; i < 24; ++i) {
    const SinCos at = sin_cos(15 * i * kRadian);
    const Vec3 direction = Vec3(0.3 * at.sin, at.sin, at.cos).normalized();
    EXPECT_NEAR(a.reach({}, direction), b.reach(X_AB, direction), 1e-11);
  }
}

TEST(Mitre, BothSidesEndInOneFaceAndKeepTheirVolume) {
  const Bar bar{16, 4, 2};
  const Side a = bar.side(true), b = bar.side(false);
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(0.1, 1, 1)}) {
    for (const double degrees : {1, 10, 45, 90, 120}) {
      SCOPED_TRACE(degrees);
      const Pose X_AB = turned(bar, rotation_by(degrees * kRadian * axis.normalized()));
      const auto plane = midplane(bar.a, bar.b, X_AB);
      ASSERT_TRUE(plane);
      const Side bent_a = mitred(a, plane->a, {2}), bent_b = mitred(b, plane->b, {3});
      for (const Side* side : {&bent_a, &bent_b}) {
        expect_sound(*side);
        EXPECT_NEAR(side->volume(), 1, 1e-13);
        EXPECT_NEAR(side->section_area(), 0.5 / plane->a.normal.x(), 1e-12);
      }
      expect_old_planes(a, bent_a, plane->a);
      expect_old_planes(b, bent_b, plane->b);
      if (axis.x() == 0) expect_same_outline(bent_a, bent_b, X_AB);
      if (degrees == 120 && axis.y() == 0) {
        // The plane reaches the 7th block of ⅛ m below, at 0.87 m, and the 4th above, at 0.43 m.
        EXPECT_EQ(a.size() - bent_a.size(), 2u * (6 + 3));
      }
    }
  }
}

/// Returns a random bend of at most 120°, with a twist of at most 0.5 rad if `twisted`.
Quat random_bend(Random& random, bool twisted) {
  const SinCos at = sin_cos(random.uniform(0, 360 * kRadian));
  const Quat bend = rotation_by(random.uniform(0, 120 * kRadian) * Vec3(0, at.sin, at.cos));
  return twisted ? bend * rotation_by(Vec3(random.uniform(-0.5, 0.5), 0, 0)) : bend;
}

TEST(Mitre, BentAgainAndAgainBothSidesStaySound) {
  Random random(7);
  for (int run = 0; run < 1000; ++run) {
    SCOPED_TRACE(run);
    const Bar bar{4 + static_cast<int>(random.below(5)), 1 + static_cast<int>(random.below(4)),
                  1 + static_cast<int>(random.below(2))};
    const Side straight_a = bar.side(true), straight_b = bar.side(false);
    Side a = straight_a, b = straight_b;
    for (std::uint64_t generation = 1; generation <= 3; ++generation) {
      const bool twisted = random.below(2);
      const Pose X_AB = turned(bar, random_bend(random, twisted));
      const auto plane = midplane(bar.a, bar.b, X_AB);
      ASSERT_TRUE(plane);
      a = mitred(a, plane->a, {2 * generation});
      b = mitred(b, plane->b, {2 * generation + 1});
      expect_sound(a);
      expect_sound(b);
      EXPECT_NEAR(a.volume(), 1, 1e-12);
      EXPECT_NEAR(b.volume(), 1, 1e-12);
      EXPECT_NEAR(a.section_area(), b.section_area(), 1e-11);
      expect_old_planes(straight_a, a, plane->a);
      expect_old_planes(straight_b, b, plane->b);
      if (!twisted) expect_same_outline(a, b, X_AB);
    }
  }
}

TEST(Mitre, TheFormerFacesGiveTheSamePlaneAsTheEdgesUnlessSidesTwist) {
  Random random(3);
  const Bar bar{4, 1, 1};
  SectionEnd face_a = bar.a, face_b = bar.b;
  Quat turn = Quat::Identity();
  for (int bend = 0; bend < 100; ++bend) {
    const Vec3 axis = face_a.along.cross(random.direction()).normalized();  // in the mitre
    turn = rotation_by(random.uniform(-0.3, 0.3) * axis) * turn;
    const Pose X_AB = turned(bar, turn);
    const auto by_edges = midplane(bar.a, bar.b, X_AB);
    const auto by_faces = midplane(face_a, face_b, X_AB);
    if (!by_edges) break;
    EXPECT_NEAR((by_edges->a.normal - by_faces->a.normal).norm(), 0, 1e-13);
    EXPECT_NEAR((by_edges->b.normal - by_faces->b.normal).norm(), 0, 1e-13);
    face_a.along = by_faces->a.normal;
    face_b.along = by_faces->b.normal;
  }
}

TEST(Mitre, BothSidesOfAnElongatedSectionGainHalfTheGap) {
  const Bar bar{8, 4, 2};
  const Quat turn = rotation_by(40 * kRadian * Vec3(0, 0.6, 0.8));
  const Vec3 normal = midplane(bar.a, bar.b, turned(bar, turn))->a.normal;
  const double gap = 0.02;
  const auto plane = midplane(bar.a, bar.b, turned(bar, turn, gap * normal));
  const double gain = 0.5 * (0.5 * gap / normal.x());
  for (const Side& side :
       {mitred(bar.side(true), plane->a, {2}), mitred(bar.side(false), plane->b, {3})}) {
    expect_sound(side);
    EXPECT_NEAR(side.volume(), 1 + gain, 1e-13);
  }
}

TEST(Mitre, BendingToAndFroGivesBackTheStraightBar) {
  const Bar bar{4, 2, 2};
  Side a = bar.side(true);
  for (std::uint64_t bend = 1; bend <= 60; ++bend) {
    const double angle = bend == 60 ? 0 : 25 * kRadian * (bend % 2 ? 1 : -1);
    const Pose X_AB = turned(bar, rotation_by(angle * Vec3::UnitZ()));
    a = mitred(a, midplane(bar.a, bar.b, X_AB)->a, {2 * bend});
  }
  const Side straight = bar.side(true);
  ASSERT_EQ(a.size(), straight.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    const ConvexPolyhedron &now = a.columns[i][0], &then = straight.columns[i][0];
    EXPECT_EQ(now.faces.size(), 6u);
    EXPECT_LT((bounds(now).min - bounds(then).min).norm(), 4e-16);
    EXPECT_LT((bounds(now).max - bounds(then).max).norm(), 4e-16);
    EXPECT_NEAR(volume(now), volume(then), 1e-16);
  }
}

TEST(Mitre, BendsOfMoreThan150DegreesHaveNoMidplane) {
  const Bar bar{4, 1, 1};
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, 0.6, 0.8)}) {
    EXPECT_TRUE(midplane(bar.a, bar.b, turned(bar, rotation_by(149.9 * kRadian * axis))));
    EXPECT_FALSE(midplane(bar.a, bar.b, turned(bar, rotation_by(150.1 * kRadian * axis))));
  }
}

TEST(Mitre, AMidplaneIsOnePlaneInBothFrames) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const SectionEnd a{random_point(random, 1), random.direction()};
    const SectionEnd b{random_point(random, 1), random.direction()};
    const Pose X_AB = random_pose(random, 1);
    const auto plane = midplane(a, b, X_AB);
    if (!plane) continue;
    for (int k = 0; k < 10; ++k) {
      const Vec3 point_B = random_point(random, 1);
      EXPECT_NEAR(plane->b.distance(point_B), -plane->a.distance(X_AB * point_B), 1e-14);
    }
    EXPECT_NEAR(plane->a.distance(a.centroid), -plane->a.distance(X_AB * b.centroid), 1e-14);
    EXPECT_NEAR(angle_between(a.along, plane->a.normal), angle_between(b.along, plane->b.normal),
                1e-12);
  }
}

/// Returns a frustum of a pyramid: 2 by 2 at y = 0, `top` by `top` at y = 1.
ConvexPolyhedron frustum(double top) {
  std::vector<Vec3> points;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      points.emplace_back(2 * x, 0, 2 * z);
      points.emplace_back(top * x, 1, top * z);
    }
  }
  return make_hull(points);
}

/// Returns `convex` with its face towards +y replaced by `plane`; empty if nothing is left.
ConvexPolyhedron with_top_in(const ConvexPolyhedron& convex, const Plane& plane) {
  MitreScratch scratch;
  ConvexPolyhedron result;
  const ColumnCell column[] = {{&convex, face_towards(convex, Vec3::UnitY())}};
  if (!mitre(column, plane, {2}, kTolerance, result, scratch)) return {};
  return result;
}

TEST(Mitre, SidesThatTaperCloseInTheirTip) {
  const Plane high = Plane::through(Vec3(0, 5, 0), Vec3::UnitY());
  const ConvexPolyhedron tip = with_top_in(frustum(1), high);
  EXPECT_TRUE(is_closed(tip));
  EXPECT_EQ(tip.faces.size(), 5u);
  EXPECT_NEAR(volume(tip), 4 * 2 / 3.0, 1e-14);  // a pyramid that is 2 high
  const ConvexPolyhedron longer =
      with_top_in(frustum(1), Plane::through(Vec3(0, 1.5, 0), Vec3::UnitY()));
  EXPECT_NEAR(volume(longer), (4 * 2 - 0.25 * 0.5) / 3.0, 1e-14);
  EXPECT_EQ(longer.faces.back().id, PlaneId{2});
}

TEST(Mitre, SidesThatFlareAreExtendedButNotWithoutLimit) {
  const Plane level = Plane::through(Vec3(0, 1.5, 0), Vec3::UnitY());
  const ConvexPolyhedron wide = frustum(4);  // a pyramid upside down, its tip at y = −1
  EXPECT_NEAR(volume(with_top_in(wide, level)), (5 * 5 * 2.5 - 2 * 2 * 1) / 3.0, 1e-13);
  // Sides at 45° never reach the steep plane, parallel to them, but volume beyond it is cut off.
  const Plane steep = Plane::through(Vec3(0, 1, 0), Vec3(1, 1, 0).normalized());
  const ConvexPolyhedron cut = with_top_in(wide, steep);
  EXPECT_TRUE(is_closed(cut));
  EXPECT_NEAR(volume(cut), volume(split(wide, steep, kTolerance).inside), 1e-15);
  EXPECT_LT(volume(cut), volume(wide));
  const Plane farther = Plane::through(Vec3(0, 9, 0), steep.normal);
  EXPECT_EQ(volume(with_top_in(wide, farther)), volume(wide));
}

TEST(Mitre, CoplanarEndFacesAreMitredAsOne) {
  ConvexPolyhedron box = cube(1);
  const ConvexPolyhedron::Face top = box.faces[3];
  const std::uint32_t* corner = box.corners.data() + top.first_corner;
  const std::array other_half = {corner[0], corner[2], corner[3]};
  box.faces[3].corner_count = 3;
  add_face(box, other_half);
  box.faces.back().plane = top.plane;
  box.corners.erase(box.corners.begin() + top.first_corner + 3);
  box.corner_normals.pop_back();
  for (std::size_t f = 4; f < box.faces.size(); ++f) --box.faces[f].first_corner;
  ASSERT_TRUE(is_closed(box));
  const ConvexPolyhedron longer = with_top_in(box, Plane::through(Vec3(0, 3, 0), Vec3::UnitY()));
  EXPECT_EQ(longer.faces.size(), 6u);
  EXPECT_NEAR(volume(longer), 16, 1e-14);
}

TEST(Mitre, WithoutABendOnlyTheFaceIdChanges) {
  const ConvexPolyhedron box = cube(1);
  const ConvexPolyhedron same = with_top_in(box, Plane::through(Vec3(0, 1, 0), Vec3::UnitY()));
  EXPECT_EQ(same.faces.size(), 6u);
  EXPECT_EQ(same.faces.back().id, PlaneId{2});
  EXPECT_EQ(volume(same), volume(box));
}

TEST(Mitre, AConvexBeyondThePlaneIsRemoved) {
  const Plane below = Plane::through(Vec3(0, -2, 0), Vec3(0.6, 0.8, 0));
  EXPECT_TRUE(with_top_in(cube(1), below).empty());
}

TEST(Mitre, ARoundColumnStaysRound) {
  const ConvexPolyhedron column = make_prism(regular_polygon(24, 0.5), -2, 0, true);
  const Plane plane = Plane::through(Vec3::Zero(), Vec3(0.6, 0.8, 0));
  const ConvexPolyhedron bent = with_top_in(column, plane);
  ASSERT_TRUE(is_closed(bent));
  EXPECT_NEAR(volume(bent), volume(column), 1e-14);
  int at_mitre = 0;
  for (const ConvexPolyhedron::Face& face : bent.faces) {
    if (std::abs(face.plane.normal.y()) > 0.5) continue;
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      const Vec3& v = bent.vertices[bent.corners[c]];
      const Vec3 radial = Vec3(v.x(), 0, v.z()).normalized();
      EXPECT_NEAR((bent.corner_normals[c].cast<double>() - radial).norm(), 0, 1e-6);
      at_mitre += std::abs(plane.distance(v)) < 1e-12;
    }
  }
  EXPECT_EQ(at_mitre, 2 * 24);
}

/// Returns a Voronoi cell of random points within a cube.
ConvexPolyhedron random_cell(Random& random) {
  ConvexPolyhedron cell = cube(1);
  const Vec3 centre = random_point(random, 0.3);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Vec3 other = random_point(random, 1.5), apart = other - centre;
    if (apart.norm() < 0.2) continue;
    const Plane plane = Plane::through(0.5 * (centre + other), apart.normalized());
    cell = split(cell, plane, kTolerance).inside;
  }
  return cell;
}

RC_GTEST_PROP(Mitre, AnyConvexEndsInAnyPlane, (std::uint64_t seed)) {
  Random random(seed);
  MitreScratch scratch;
  ConvexPolyhedron convex = random.below(2) ? random_cell(random) : random_solid(random, 1);
  for (std::uint64_t bend = 1; bend <= 4 && !convex.empty(); ++bend) {
    const auto face = static_cast<std::uint32_t>(random.below(convex.faces.size()));
    const Vec3 lean = random.uniform(0, 3.5) * random.direction();
    const Plane plane =
        Plane::through(convex.vertices[convex.face_corners(face)[0]] + random_point(random, 0.2),
                       (convex.faces[face].plane.normal + lean).normalized());
    ConvexPolyhedron result;
    const ColumnCell column[] = {{&convex, face}};
    if (!mitre(column, plane, {2 * bend}, kTolerance, result, scratch)) break;
    ASSERT_TRUE(is_closed(result));
    ASSERT_TRUE(is_convex(result, 1e-12));
    for (const Vec3& v : result.vertices) {
      EXPECT_LE(plane.distance(v), 1e-12);
      for (std::uint32_t f = 0; f < convex.faces.size(); ++f) {
        EXPECT_TRUE(f == face || convex.faces[f].plane.distance(v) <= 1e-12);
      }
    }
    EXPECT_GE(volume(result), volume(split(convex, plane, kTolerance).inside) - 1e-12);
    convex = result;
  }
}

}  // namespace
}  // namespace sunder::geometry_mitre_test
