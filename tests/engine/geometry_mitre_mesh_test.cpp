// Tests of mitres of visual meshes: watertight, with unchanged volume.
#include <gtest/gtest.h>

#include "engine/geometry/mitre.h"
#include "tests/engine/geometry_mesh_fixtures.h"

namespace sunder {
namespace {

using namespace test;

/// Returns the lower half, 10 m long, of a solid swept along y; its cap at y = 0 has the id 4.
PolygonMesh lower_half(PolygonMesh mesh) {
  for (Vec3& v : mesh.vertices) v.y() = 20 * (v.y() - 0.5);
  for (PolygonMesh::Face& face : mesh.faces) {
    const Vec3& corner = mesh.vertices[mesh.contour_corners(face.first_contour)[0]];
    face.plane = Plane::through(corner, face.plane.normal);
  }
  MeshClipScratch scratch;
  PolygonMesh half;
  clip(mesh, {Vec3::UnitY(), 0}, {4}, 0, half, scratch);
  half.corner_uvs.resize(half.corners.size(), Vec2f(1, 2));
  return half;
}

TEST(Mitre, VisualMeshesKeepTheirVolumeToo) {
  MeshClipScratch scratch;
  PolygonMesh bent;
  for (const PolygonMesh& straight : {lower_half(ring()), lower_half(comb(5))}) {
    Vec3 centroid = mass_properties(straight).centroid;
    centroid.y() = 0;
    for (const Vec3& lean : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 0, 0.3), Vec3(-1, 0, 3)}) {
      const Plane plane = Plane::through(centroid, (Vec3::UnitY() + lean).normalized());
      ASSERT_EQ(mitre(straight, {4}, Vec3::UnitY(), plane, {6}, 0, bent, scratch), PlaneSide::kCut);
      EXPECT_EQ(open_edges(bent), 0u);
      EXPECT_EQ(bent.corner_uvs.size(), bent.corners.size());
      EXPECT_EQ(bent.corner_normals.size(), bent.corners.size());
      EXPECT_EQ(first_cap(bent), bent.faces.size() - 1);
      EXPECT_EQ(bent.faces.back().id, PlaneId{6});
      EXPECT_NEAR(volume(bent), volume(straight), 1e-12);
      for (std::size_t c = 0; c < bent.corners.size(); ++c) {
        if (bent.vertices[bent.corners[c]].y() < -9) {
          EXPECT_EQ(bent.corner_uvs[c], Vec2f(1, 2));
        }
      }
      for (const PolygonMesh::Face& face : bent.faces) {
        for (std::uint32_t k = 0; k < face.contour_count; ++k) {
          for (const std::uint32_t v : bent.contour_corners(face.first_contour + k)) {
            EXPECT_NEAR(face.plane.distance(bent.vertices[v]), 0, 1e-13);
          }
        }
      }
    }
  }
}

TEST(Mitre, VisualMeshesOfAnyShapeStayWatertight) {
  MeshClipScratch scratch;
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    PolygonMesh mesh = random_mesh(random), cut;
    for (std::uint64_t bend = 1; bend <= 3; ++bend) {
      const Plane plane = random_plane(random, 0.3);
      const Vec3 along = (plane.normal + 0.9 * random.direction()).normalized();
      const PlaneSide side = mitre(mesh, {2 * bend}, along, plane, {2 * bend + 2}, 0, cut, scratch);
      if (side == PlaneSide::kOutside) break;
      if (side == PlaneSide::kCut) mesh = cut;
      ASSERT_EQ(open_edges(mesh), 0u);
      for (const PolygonMesh::Face& face : mesh.faces) EXPECT_NE(face.id, PlaneId{2 * bend});
    }
  }
}

}  // namespace
}  // namespace sunder
