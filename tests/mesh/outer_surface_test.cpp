// Tests that outer surfaces of pieces omit shared faces, and that every edge has two faces.
#include "engine/geometry/walls/outer_surface.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/mesh/export_model.h"
#include "fracture/fracture.h"
#include "fracture/solids.h"

namespace sunder {
namespace {

/// Returns the surface of a box whose faces in the plane x = 1 have the ids of one cut's sides.
PolygonMesh box_at_cut(const Vec3& min, const Vec3& max) {
  PolygonMesh mesh = polygon_mesh(make_box(min, max));
  for (PolygonMesh::Face& face : mesh.faces) {
    face.id = {};
    if (std::abs(face.plane.normal.x()) < 0.5) continue;
    if (std::abs(std::abs(face.plane.d) - 1) < 1e-12)
      face.id = {face.plane.normal.x() > 0 ? 2u : 3u};
  }
  return mesh;
}

double area(const PolygonMesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) sum += face_area(mesh, f);
  return sum;
}

void expect_outer(const PolygonMesh& a, const PolygonMesh& b, double volume_m3, double area_m2) {
  const PolygonMesh* const both[] = {&a, &b};
  const std::optional<OuterSurface> outer = outer_surface(both);
  ASSERT_TRUE(outer);
  EXPECT_EQ(open_edges(outer->mesh), 0u);
  EXPECT_NEAR(mass_properties(outer->mesh).volume_m3, volume_m3, 1e-12);
  EXPECT_NEAR(area(outer->mesh), area_m2, 1e-12);
}

TEST(OuterSurface, OfBoxesWithASharedFaceOmitsTheFace) {
  expect_outer(box_at_cut({0, 0, 0}, {1, 1, 1}), box_at_cut({1, 0, 0}, {2, 1, 1}), 2, 10);
}

TEST(OuterSurface, OfABoxOnPartOfAFaceKeepsTheRestOfIt) {
  const PolygonMesh wall = box_at_cut({0, 0, 0}, {1, 1, 1});
  // The box is inside the face.
  expect_outer(wall, box_at_cut({1, 0.25, 0.25}, {2, 0.75, 0.75}), 1.25, 6 + 2);
  // The box is at an edge.
  expect_outer(wall, box_at_cut({1, 0, 0.25}, {2, 0.5, 0.75}), 1.25, 6 + 2);
  // The box crosses an edge.
  expect_outer(wall, box_at_cut({1, 0.5, 0.5}, {2, 1.5, 1.5}), 2, 12 - 2 * 0.25);
  expect_outer(wall, box_at_cut({1, -0.5, 0.25}, {2, 1.5, 0.5}), 1.5,
               6 + 5.5 - 2 * .25);  // The box crosses the whole face.
}

TEST(OuterSurface, OfBoxesThatTouchInAnEdgeHasTheEdgeOncePerBox) {
  const PolygonMesh a = box_at_cut({0, 0, 0}, {1, 1, 1});
  const PolygonMesh b = box_at_cut({1, 1, 0}, {2, 2, 1});
  const PolygonMesh* const both[] = {&a, &b};
  const std::optional<OuterSurface> outer = outer_surface(both);
  ASSERT_TRUE(outer);
  EXPECT_EQ(open_edges(outer->mesh), 0u);
  EXPECT_EQ(outer->mesh.vertices.size(), 18u) << "each box has a middle of the edge";
  std::set<std::vector<double>> places;
  for (const Vec3& vertex : outer->mesh.vertices)
    places.insert({vertex.x(), vertex.y(), vertex.z()});
  EXPECT_EQ(places.size(), 16u) << "each box has its own position of the vertex";
}

TEST(OuterSurface, HasOnePointWhereEdgesCrossAtAVertexOnBoth) {
  // Left of the cut an edge along z passes (1, 1, 1), right of it one along y, and two boxes have a
  // vertex there.
  const PolygonMesh boxes[] = {box_at_cut({0, 0, 0}, {1, 1, 2}), box_at_cut({0, 1, 0}, {1, 2, 2}),
                               box_at_cut({1, 0, 0}, {2, 2, 1}), box_at_cut({1, 0, 1}, {2, 1, 2}),
                               box_at_cut({1, 1, 1}, {2, 2, 2})};
  std::vector<const PolygonMesh*> all;
  for (const PolygonMesh& box : boxes) all.push_back(&box);
  const std::optional<OuterSurface> outer = outer_surface(all);
  ASSERT_TRUE(outer);
  EXPECT_EQ(open_edges(outer->mesh), 0u);
  EXPECT_NEAR(mass_properties(outer->mesh).volume_m3, 8, 1e-12);
}

TEST(OuterSurface, OfAnOpenMeshIsEmpty) {
  PolygonMesh a = box_at_cut({0, 0, 0}, {1, 1, 1});
  a.contours.pop_back();
  a.faces.pop_back();
  const PolygonMesh b = box_at_cut({1, 0, 0}, {2, 1, 1});
  const PolygonMesh* const both[] = {&a, &b};
  EXPECT_FALSE(outer_surface(both));
}

TEST(Model, ASolidOfManyConvexesIsOneShell) {
  for (const char* name : {"grid:3,2,4", "voronoi:40", "torus:1,0.3", "column:0.5,4"}) {
    const Compound solid = fracture::make_solid(name);
    Material stone;
    const Model model = make_model(std::span(&solid, 1), std::span(&stone, 1), 0);
    EXPECT_EQ(model.parts_with_walls, 0u) << name;
    ASSERT_EQ(model.parts[0].shells.size(), 1u) << name;
    const PolygonMesh& mesh = *model.parts[0].shells[0].mesh;
    EXPECT_EQ(open_edges(mesh), 0u) << name;
    EXPECT_NEAR(mass_properties(mesh).volume_m3, volume(solid), 1e-12 * volume(solid)) << name;
    const Model kept = make_model(std::span(&solid, 1), std::span(&stone, 1), 0, {}, Walls::kKeep);
    EXPECT_EQ(kept.parts[0].shells.size(), solid.convexes.size()) << name;
  }
}

}  // namespace
}  // namespace sunder
