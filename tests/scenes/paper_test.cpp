// Tests of the claims of the paper's figures, on the scenes that show them (docs/paper.md).
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "engine/model/piece_mesh.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "scenes/sculpture/implicit_surface.h"
#include "scenes/sculpture/statue.h"

namespace sunder::scenes {
namespace {

const std::string kFolder = SUNDER_ROOT "/scenes/meshes/";

RepairedMesh repaired(const std::string& name) {
  return repair_mesh(read_mesh(kFolder + name), name);
}

double area_m2(const PolygonMesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) sum += face_area(mesh, f);
  return sum;
}

/// Returns the area of a compound that is drawn.
double drawn_m2(const Compound& compound) {
  const auto hidden = hidden_faces(compound);
  double sum = 0;
  for (std::size_t c = 0; c < hidden.size(); ++c) {
    const auto mesh = make_mesh(*compound.convexes[c], hidden[c]);
    if (!mesh) continue;
    for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
      const auto at = [&](std::size_t k) {
        return mesh->vertices[mesh->indices[i + k]].position.cast<double>().eval();
      };
      sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    }
  }
  return sum;
}

TEST(Figure4, ACompoundOfTwelveNodesLooksLikeItsTorus) {
  const Scene scene = load_scene("torus", {});
  ASSERT_EQ(scene.solids.size(), 1u);
  const Compound& compound = scene.solids[0].compound;
  EXPECT_EQ(compound.convexes.size(), 12u);
  EXPECT_EQ(compound.bonds.size(), 12u) << "a ring";
  const PolygonMesh torus = repaired("torus.obj").shells.at(0);
  const double volume_m3 = mass_properties(torus).volume_m3;
  EXPECT_NEAR(volume(compound), volume_m3, 1e-12 * volume_m3);
  double hulls_m3 = 0;
  for (const ConvexPtr& convex : compound.convexes) {
    hulls_m3 += mass_properties(convex->polyhedron).volume_m3;
  }
  EXPECT_LT(hulls_m3, 1.1 * volume_m3);
  // No cap between convexes is seen, and all of the torus is.
  EXPECT_NEAR(drawn_m2(compound), area_m2(torus), 1e-4 * area_m2(torus));
}

TEST(Figure6, ThePileIsWholeInTheAirAndBreaksAsItFalls) {
  const auto simulation = make_simulation(load_scene("pile", {"draft", {}}));
  std::size_t breaks = 0;
  FramePtr frame;
  for (int i = 0; i < 12; ++i) breaks += (frame = simulation->next())->breaks.size();
  EXPECT_EQ(frame->bodies.size(), 22u);
  EXPECT_EQ(breaks, 0u) << "all in the air";
  for (int i = 0; i < 40; ++i) breaks += (frame = simulation->next())->breaks.size();
  EXPECT_GT(breaks, 3u);
  EXPECT_GT(frame->bodies.size(), 60u);
}

TEST(Figure12, MeshesThatOverlapBecomeOneSolidWithoutANode) {
  MeshOptions options;
  options.convexes = 8;
  options.fit = "aabb";
  const std::string file = kFolder + "portico.obj";
  const Compound compound = make_compound(file, MaterialIndex(0u), options);
  EXPECT_EQ(compound.convexes.size(), 8u) << "floor, roof, columns";
  EXPECT_EQ(compound.ghosts.size(), 12u) << "at either end of a column";
  EXPECT_EQ(split_islands(compound).size(), 1u);
  const Scene scene = load_scene("portico", {});
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_GT(scene.solids[0].compound.convexes.size(), 20u);
}

TEST(Figure10, AStatueIsOneSoundSurfaceOfAsManyTrianglesAsAskedFor) {
  for (const std::uint32_t triangles : {5000u, 80000u}) {
    const RawMesh raw = make_statue(triangles);
    EXPECT_NEAR(double(raw.polygons.size()), triangles, 0.12 * triangles);
    const RepairedMesh statue = repair_mesh(raw, "statue");
    EXPECT_TRUE(statue.closed);
    EXPECT_TRUE(statue.repairs.empty()) << statue.repairs[0].name;
    ASSERT_EQ(statue.shells.size(), 1u);
    const MassProperties solid = mass_properties(statue.shells[0]);
    EXPECT_NEAR(solid.volume_m3, 0.28, 0.012);
    // The statue stands: its centre is above its base, 0.72 m wide.
    EXPECT_LT(std::abs(solid.centroid.x()), 0.1);
    EXPECT_LT(std::abs(solid.centroid.z()), 0.1);
  }
}

TEST(Figure10, TwelveNodesFitAStatueTightly) {
  const Scene scene = load_scene("statue", {});
  ASSERT_EQ(scene.solids.size(), 2u) << "and its plinth";
  const Compound& statue = scene.solids[1].compound;
  EXPECT_GE(statue.convexes.size(), 12u);
  EXPECT_LT(statue.convexes.size(), 30u);
  std::size_t largest = 0;
  double hulls_m3 = 0;
  for (const ConvexPtr& convex : statue.convexes) {
    hulls_m3 += mass_properties(convex->polyhedron).volume_m3;
    if (convex->visual) largest = std::max(largest, convex->visual->faces.size());
  }
  EXPECT_LT(hulls_m3, 1.3 * volume(statue));
  EXPECT_LT(largest, 11000u);
}

Box around(double half_m) { return {Vec3::Constant(-half_m), Vec3::Constant(half_m)}; }

TEST(ImplicitSurface, OfABallIsTheBall) {
  const RawMesh raw = triangulate([](const Vec3& p) { return p.norm() - 1; }, around(1), 0.07);
  for (const Vec3& v : raw.vertices) EXPECT_NEAR(v.norm(), 1, 1e-6);
  for (std::size_t c = 0; c < raw.corners.size(); ++c) {
    EXPECT_LT((raw.corner_normals[c].cast<double>() - raw.vertices[raw.corners[c]]).norm(), 1e-4);
  }
  const RepairedMesh ball = repair_mesh(raw, "ball");
  EXPECT_TRUE(ball.repairs.empty());
  EXPECT_NEAR(mass_properties(ball.shells.at(0)).volume_m3, 4 * M_PI / 3, 0.02);
}

TEST(ImplicitSurface, IsWatertightWhereSheetsShareACell) {
  // Bubbles about as large as cells, which touch across edges and corners of the cells.
  const auto foam = [](const Vec3& p) {
    const Vec3 q = 9 * p + Vec3(0.3, 0.1, 0.7);
    const Vec3 wave(q.x() - std::floor(q.x()), q.y() - std::floor(q.y()),
                    q.z() - std::floor(q.z()));
    return std::max((wave - Vec3::Constant(0.5)).norm() / 9 - 0.049, p.norm() - 1);
  };
  for (const double cell_m : {0.031, 0.047, 0.06}) {
    const RawMesh raw = triangulate(foam, around(1), cell_m);
    const RepairedMesh mesh = repair_mesh(raw, "foam");
    EXPECT_TRUE(mesh.closed) << cell_m;
    EXPECT_FALSE(mesh.shells.empty());
  }
}

TEST(ImplicitSurface, IsTheSameForAnyNumberOfThreads) {
  set_threads(1);
  const RawMesh one = make_statue(3000);
  set_threads(5);
  const RawMesh many = make_statue(3000);
  set_threads(0);
  EXPECT_EQ(one.vertices, many.vertices);
  EXPECT_EQ(one.corners, many.corners);
  EXPECT_EQ(one.corner_normals, many.corner_normals);
}

}  // namespace
}  // namespace sunder::scenes
