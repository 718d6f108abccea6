// Tests of figure 9 of the paper: cuts of polygon meshes make few faces, while cuts of triangle
// meshes make more and more triangles of worse shape.
#include <gtest/gtest.h>

#include "engine/base/trigonometry.h"
#include "engine/geometry/prism.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/fixtures/triangles.h"

namespace sunder {
namespace {

PolygonMesh hexagonal_prism() {
  std::vector<Vec2> corners;
  for (int i = 0; i < 6; ++i) {
    const SinCos turn = sin_cos(6.283185307179586 * i / 6);
    corners.emplace_back(turn.sin, turn.cos);
  }
  return polygon_mesh(make_prism(corners, 0, 1, false));
}

/// Returns the number of upward faces of all pieces.
std::size_t upward_faces(const std::vector<PolygonMesh>& pieces) {
  std::size_t count = 0;
  for (const PolygonMesh& piece : pieces)
    for (const PolygonMesh::Face& face : piece.faces) count += face.plane.normal.y() > 0.999;
  return count;
}

TEST(Polygons, AHexagonSplitTwiceIsFourPolygonsAndThriceAsManyTriangles) {
  std::vector<PolygonMesh> polygons = {hexagonal_prism()};
  std::vector<PolygonMesh> triangles = {triangulated(polygons[0])};
  EXPECT_EQ(upward_faces(triangles), 4u);
  const Vec3 normals[] = {Vec3(1, 0, 0.3).normalized(), Vec3(0.2, 0, 1).normalized()};
  for (std::size_t i = 0; i < 2; ++i) {
    const Plane plane = Plane::through(Vec3(0.05, 0, 0.02), normals[i]);
    polygons = cut_all(polygons, plane, {2 * i + 2}, false);
    triangles = cut_all(triangles, plane, {2 * i + 2}, true);
  }
  EXPECT_EQ(upward_faces(polygons), 4u);
  EXPECT_GE(upward_faces(triangles), 12u);
}

TEST(Polygons, OfARepeatedlyCutTorusAreFewerThanTrianglesByAGrowingFactor) {
  const std::string file = SUNDER_ROOT "/scenes/meshes/torus.obj";
  const PolygonMesh torus = repair_mesh(read_mesh(file), file).shells.at(0);
  std::vector<PolygonMesh> polygons = {torus}, triangles = {triangulated(torus)};
  const double volume_m3 = total_volume_m3(polygons);
  const std::vector<Plane> planes = planes_through(bounds(torus), 6);
  std::size_t ill_count = ill_shaped(triangles);
  double ratio = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    polygons = cut_all(polygons, planes[i], {2 * i + 2}, false);
    triangles = cut_all(triangles, planes[i], {2 * i + 2}, true);
    ASSERT_EQ(polygons.size(), triangles.size());
    for (const PolygonMesh& piece : triangles) ASSERT_EQ(open_edges(piece), 0u);
    EXPECT_NEAR(total_volume_m3(polygons), volume_m3, 1e-12);
    EXPECT_NEAR(total_volume_m3(triangles), volume_m3, 1e-9)
        << "both cutters must make the same volumes";
    const double now = double(face_count(triangles)) / double(face_count(polygons));
    EXPECT_GT(now, ratio);
    EXPECT_GE(ill_shaped(triangles), ill_count);
    ratio = now;
    ill_count = ill_shaped(triangles);
  }
  EXPECT_GT(ratio, 1.5);
  EXPECT_GT(ill_count, 2 * ill_shaped(polygons));
}

}  // namespace
}  // namespace sunder
