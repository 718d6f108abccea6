// Tests that the audit of a surface finds each fault of small meshes, and no other.
#include "engine/geometry/repair/surface_audit.h"

#include <gtest/gtest.h>

#include "engine/geometry/repair/clean.h"
#include "tests/mesh/made_meshes.h"

namespace sunder {
namespace {

using test::append;

/// Returns a box of twelve triangles; with `is_reversed` it is inside out.
RawMesh box(const Vec3& low, const Vec3& high, bool is_reversed = false) {
  RawMesh mesh = triangle_mesh(polygon_mesh(make_box(low, high)));
  for (std::size_t p = 0; is_reversed && p < mesh.polygons.size(); ++p) reverse_polygon(mesh, p);
  return mesh;
}

RawMesh unit_box() { return box(Vec3::Zero(), Vec3::Ones()); }

SurfaceAudit audit_of_two(const RawMesh& a, const RawMesh& b) {
  RawMesh both = a;
  append(both, b);
  return audit_surface(std::move(both));
}

/// Expects the figures of a surface without faults.
void expect_sound(const SurfaceAudit& audit, std::size_t islands, double volume_m3) {
  EXPECT_TRUE(audit.is_sound());
  EXPECT_EQ(audit.collapsed_triangles, 0u);
  EXPECT_EQ(audit.open_edges, 0u);
  EXPECT_EQ(audit.non_manifold_edges, 0u);
  EXPECT_EQ(audit.twin_points, 0u);
  EXPECT_EQ(audit.inside_out_islands, 0u);
  EXPECT_EQ(audit.inside_out_m3, 0);
  EXPECT_EQ(audit.islands, islands);
  EXPECT_NEAR(audit.volume_m3, volume_m3, 1e-14);
}

TEST(SurfaceAudit, OfACubeFindsNothing) {
  const SurfaceAudit audit = audit_surface(unit_box());
  expect_sound(audit, 1, 1);
  EXPECT_EQ(audit.triangles, 12u);
}

TEST(SurfaceAudit, OfAnEmptyMeshIsNotSound) { EXPECT_FALSE(audit_surface({}).is_sound()); }

TEST(SurfaceAudit, TakesVerticesAtOnePlaceForOne) {
  RawMesh soup;
  const RawMesh whole = unit_box();
  for (std::size_t t = 0; t < whole.polygons.size(); ++t) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : whole.polygon_corners(t)) {
      corners.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.push_back(whole.vertices[v]);
    }
    append_polygon(soup, corners, RawMesh::kNoGroup);
  }
  expect_sound(audit_surface(std::move(soup)), 1, 1);
}

TEST(SurfaceAudit, AHollowIsNotInsideOut) {
  const RawMesh hollow = box(Vec3::Constant(.25), Vec3::Constant(.75), true);
  expect_sound(audit_of_two(unit_box(), hollow), 2, 1 - .125);
}

TEST(SurfaceAudit, AHollowMayTouchASideAnEdgeOrACorner) {
  for (const Vec3& low : {Vec3(0, .25, .25), Vec3(0, 0, .25), Vec3(0, 0, 0)})
    expect_sound(audit_of_two(unit_box(), box(low, low + Vec3::Constant(.5), true)), 2, 1 - .125);
  // The hollow ends in the diagonal of a side, which is thus in four triangles.
  RawMesh wedge = test::make_block(Vec3(0, 0, .25), Vec3(.5, .5, .75), true);
  for (std::size_t p = 0; p < wedge.polygons.size(); ++p) reverse_polygon(wedge, p);
  RawMesh triangles;
  triangles.vertices = wedge.vertices;
  for (const test::Polygon& polygon : test::polygons_of(wedge)) {
    for (std::size_t i = 2; i < polygon.size(); ++i)
      test::add(triangles, {polygon[0], polygon[i - 1], polygon[i]});
  }
  EXPECT_EQ(audit_of_two(unit_box(), triangles).inside_out_islands, 0u);
}

TEST(SurfaceAudit, AnIslandInAHollowIsSolid) {
  RawMesh shell = unit_box();
  append(shell, box(Vec3::Constant(.2), Vec3::Constant(.8), true));
  expect_sound(audit_of_two(shell, box(Vec3::Constant(.4), Vec3::Constant(.6))), 3,
               1 - .216 + .008);
}

TEST(SurfaceAudit, FindsAnInsideOutIslandBesideACubeAndInAHollow) {
  const SurfaceAudit beside = audit_of_two(unit_box(), box(Vec3(2, 0, 0), Vec3(2.5, .5, .5), true));
  EXPECT_EQ(beside.inside_out_islands, 1u);
  EXPECT_NEAR(beside.inside_out_m3, .125, 1e-15);
  EXPECT_NEAR(beside.volume_m3, .875, 1e-15);
  EXPECT_FALSE(beside.is_sound());
  RawMesh shell = unit_box();
  append(shell, box(Vec3::Constant(.2), Vec3::Constant(.8), true));
  const SurfaceAudit within =
      audit_of_two(shell, box(Vec3::Constant(.4), Vec3::Constant(.6), true));
  EXPECT_EQ(within.inside_out_islands, 1u);
  EXPECT_EQ(within.islands, 3u);
}

TEST(SurfaceAudit, FindsAnInsideOutIslandThatTouchesTheCube) {
  // From outside, at a side, an edge and a corner.
  for (const Vec3& low : {Vec3(1, .25, .25), Vec3(1, 1, .25), Vec3(1, 1, 1)}) {
    const SurfaceAudit audit = audit_of_two(unit_box(), box(low, low + Vec3::Constant(.5), true));
    EXPECT_EQ(audit.inside_out_islands, 1u) << low.transpose();
    EXPECT_EQ(audit.open_edges, 0u);
  }
}

TEST(SurfaceAudit, FindsTheCommonEdgeOfTwoCubes) {
  const SurfaceAudit audit = audit_of_two(unit_box(), box(Vec3(1, 1, 0), Vec3(2, 2, 1)));
  EXPECT_EQ(audit.non_manifold_edges, 1u);
  EXPECT_EQ(audit.open_edges, 0u);
  EXPECT_EQ(audit.islands, 2u);
  EXPECT_EQ(audit.inside_out_islands, 0u);
  EXPECT_NEAR(audit.volume_m3, 2, 1e-14);
  EXPECT_FALSE(audit.is_sound());
}

TEST(SurfaceAudit, FindsOpenAndReversedTriangles) {
  RawMesh open = unit_box();
  open.polygons.pop_back();
  open.corners.resize(open.corners.size() - 3);
  EXPECT_EQ(audit_surface(std::move(open)).open_edges, 3u);
  RawMesh reversed = unit_box();
  reverse_polygon(reversed, 0);
  EXPECT_EQ(audit_surface(std::move(reversed)).open_edges, 3u);
}

TEST(SurfaceAudit, FindsTwinsThatNoEdgeJoins) {
  const Vec3 step = Vec3::Constant(5e-9);
  EXPECT_EQ(audit_of_two(unit_box(), box(Vec3::Ones() + step, Vec3::Constant(2))).twin_points, 1u);
  EXPECT_EQ(audit_of_two(unit_box(), box(step, Vec3::Ones() + step)).twin_points, 8u);
  // Apart by more than the distance, and a box whose edges are shorter than it.
  EXPECT_EQ(audit_of_two(unit_box(), box(Vec3::Ones() + 2 * step, Vec3::Constant(2))).twin_points,
            0u);
  expect_sound(audit_surface(box(Vec3::Zero(), Vec3(1, 4e-9, 4e-9))), 1, 1.6e-17);
}

TEST(SurfaceAudit, FindsTrianglesWithEqualCorners) {
  RawMesh mesh = unit_box();
  test::add(mesh, {0, 1, 0});
  mesh.vertices.push_back(Vec3(mesh.vertices[0]));
  test::add(mesh, {0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  const SurfaceAudit audit = audit_surface(std::move(mesh));
  EXPECT_EQ(audit.collapsed_triangles, 2u);
  EXPECT_EQ(audit.triangles, 12u);
  EXPECT_EQ(audit.open_edges, 0u);
  EXPECT_FALSE(audit.is_sound());
}

TEST(SurfaceAudit, AFlatIslandIsNotInsideOut) {
  RawMesh flat;
  flat.vertices = {{.1, .2, .3}, {.7, .1, .4}, {.3, .9, .2}};
  test::add(flat, {0, 1, 2});
  test::add(flat, {2, 1, 0});
  EXPECT_EQ(audit_of_two(unit_box(), flat).inside_out_islands, 0u);
}

TEST(SurfaceAudit, IsAddedFigureByFigure) {
  SurfaceAudit sum = audit_of_two(unit_box(), box(Vec3(2, 0, 0), Vec3(3, 1, 1), true));
  sum += audit_of_two(unit_box(), box(Vec3(1, 1, 0), Vec3(2, 2, 1)));
  EXPECT_EQ(sum.triangles, 48u);
  EXPECT_EQ(sum.islands, 4u);
  EXPECT_EQ(sum.inside_out_islands, 1u);
  EXPECT_EQ(sum.non_manifold_edges, 1u);
  EXPECT_NEAR(sum.volume_m3, 2, 1e-14);
  EXPECT_NEAR(sum.inside_out_m3, 1, 1e-14);
}

}  // namespace
}  // namespace sunder
