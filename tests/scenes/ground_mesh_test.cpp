// Tests of ground meshes: their keys in a scene, how they are drawn, and bodies at rest on them.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes::ground_mesh_test {
namespace {

constexpr const char* kHead = "[scene]\ndescription = \"x\"\n";

Scene scene_of(const std::string& text, const LoadOptions& options = {}) {
  return parse_scene(kHead + text, "x.toml", options);
}

std::string refusal(const std::string& text) {
  try {
    scene_of(text);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// A mesh file that exists during the lifetime of its object.
class MeshFile {
 public:
  explicit MeshFile(const std::string& text)
      : path_(std::filesystem::path(testing::TempDir()) / "ground_mesh_test.obj") {
    std::ofstream(path_) << text;
  }
  ~MeshFile() { std::filesystem::remove(path_); }
  std::string table() const { return "[[ground.mesh]]\nmesh = \"" + path_.string() + "\"\n"; }

 private:
  std::filesystem::path path_;
};

FramePtr after(FrameSource& simulation, int frames) {
  FramePtr frame;
  for (int i = 0; i <= frames; ++i) frame = simulation.next();
  return frame;
}

TEST(GroundMesh, HeightsBecomeTrianglesCentredAtTheirPosition) {
  const Scene scene = scene_of(
      "[[ground.mesh]]\nheights_m = [[1, 4, 2], [3, 2, 5]]\nspacing_m = 2\n"
      "position = [10, 1, 0]\nrepeat = { count = 2, step_m = [0, 0, 20] }\n");
  ASSERT_EQ(scene.ground.meshes.size(), 2u);
  const GroundMesh& mesh = scene.ground.meshes[1];
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.vertices_W[0], Vec3(8, 2, 19));
  EXPECT_EQ(mesh.vertices_W[5], Vec3(12, 6, 21));
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices_W[t[0]];
    EXPECT_GT((mesh.vertices_W[t[1]] - a).cross(mesh.vertices_W[t[2]] - a).y(), 0) << "face up";
  }
}

TEST(GroundMesh, AMirroredMeshStillFacesUp) {
  const Scene scene =
      scene_of("[[ground.mesh]]\nhills_m = 3\nwidth_m = 10\ndepth_m = 8\nmirror = \"x\"\n");
  ASSERT_EQ(scene.ground.meshes.size(), 2u);
  for (const GroundMesh& mesh : scene.ground.meshes) {
    EXPECT_EQ(mesh.triangles.size(), 160u);
    for (const auto& t : mesh.triangles) {
      const Vec3& a = mesh.vertices_W[t[0]];
      EXPECT_GT((mesh.vertices_W[t[1]] - a).cross(mesh.vertices_W[t[2]] - a).y(), 0);
    }
  }
}

TEST(GroundMesh, HillsHaveTheirHeightAndDependOnTheirSeed) {
  const auto heights = [](const std::string& seed) {
    const Scene scene = scene_of(
        "[[ground.mesh]]\nhills_m = 4\nhill_length_m = 10\nwidth_m = 80\ndepth_m = 80\nseed = " +
        seed + "\n");
    return scene.ground.meshes[0].vertices_W;
  };
  const std::vector<Vec3> one = heights("1"), other = heights("2");
  const auto [low, high] = std::ranges::minmax(one, {}, [](const Vec3& v) { return v.y(); });
  EXPECT_GT(high.y() - low.y(), 2.4);
  EXPECT_LT(high.y() - low.y(), 5.6);
  EXPECT_NE(one, other);
  EXPECT_EQ(one, heights("1"));
}

TEST(GroundMesh, HasTheFrictionRestitutionAndColourOfTheGroundUnlessItNamesAMaterial) {
  const Scene scene = scene_of(
      "[ground]\nfriction = 0.3\nrestitution = 0.2\n[view]\nground_color = [0.1, 0.2, 0.3]\n"
      "[[ground.mesh]]\nhills_m = 1\n[[ground.mesh]]\nhills_m = 1\nmaterial = \"stone\"\n");
  const Material& own = scene.materials[scene.ground.meshes[0].material.value];
  EXPECT_EQ(own.friction, 0.3);
  EXPECT_EQ(own.restitution, 0.2);
  EXPECT_EQ(own.surface.color, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(scene.materials[scene.ground.meshes[1].material.value].name, "stone");
}

TEST(GroundMesh, AFileMayBeOpenAndHaveFacesOfManyCorners) {
  const MeshFile file(
      "v 0 0 0\nv 0 0 2\nv 2 0 2\nv 2 0 0\nv 4 1 0\nv 4 1 2\nf 1 2 3 4\nf 4 3 6 5\n");
  const Scene scene = scene_of(file.table() + "scale = 2\n");
  EXPECT_EQ(scene.ground.meshes[0].triangles.size(), 4u);
  EXPECT_EQ(scene.ground.meshes[0].vertices_W[4], Vec3(8, 2, 0));
}

TEST(GroundMesh, RefusesFaultsWithTheirPlace) {
  const std::string at = "x.toml:3: ";
  EXPECT_EQ(refusal("[[ground.mesh]]\nspacing_m = 1\n"),
            at + "[[ground.mesh]] has none of mesh, heights_m and hills_m; give exactly one");
  EXPECT_EQ(
      refusal("[[ground.mesh]]\nhills_m = 1\nheights_m = [[1, 2], [3, 4]]\n"),
      at + "[[ground.mesh]] has more than one of mesh, heights_m and hills_m; give exactly one");
  EXPECT_EQ(refusal("[[ground.mesh]]\nhills_m = 1\nspacing_m = 0.01\nwidth_m = 1000\n"),
            at + "[[ground.mesh]] has 8e+08 triangles; allowed: at most 1000000; increase "
                 "spacing_m, reduce its size, or simplify the mesh");
  EXPECT_NE(refusal("[[ground.mesh]]\nmesh = \"none.obj\"\n").find("x.toml:3: none.obj"),
            std::string::npos);
  EXPECT_NE(refusal("[[ground.mesh]]\nhills_m = 1\nhigh = 2\n").find("unknown key 'high'"),
            std::string::npos);
  EXPECT_NE(
      refusal("[[ground.mesh]]\nhills_m = 1\nmaterial = \"chese\"\n").find("unknown material"),
      std::string::npos);
  EXPECT_EQ(refusal("[[ground.mesh]]\nhills_m = 1\nposition = [999990, 0, 0]\n"),
            at + "[[ground.mesh]] has a coordinate beyond 1e+06 m; reduce its scale, or move it");
  EXPECT_NE(refusal("planar = true\n[[ground.mesh]]\nhills_m = 1\n")
                .find("planar = true in [scene], but it has a [[ground.mesh]]"),
            std::string::npos);
}

TEST(GroundMesh, RefusesFilesThatAreNoSurface) {
  const MeshFile line("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_EQ(refusal(line.table()),
            "x.toml:3: [[ground.mesh]] has no triangle with an area above 0");
  const MeshFile opposite("v 0 0 0\nv 0 0 2\nv 2 0 2\nv 2 0 0\nf 1 2 3\nf 1 4 3\n");
  EXPECT_EQ(refusal(opposite.table()),
            "x.toml:3: two neighbouring triangles of [[ground.mesh]] at [1, 0, 1] have opposite "
            "orientations; reverse one of them: bodies collide with the side from which the "
            "vertices are counter-clockwise");
  const MeshFile infinite("v 0 0 0\nv 0 0 inf\nv 2 0 2\nf 1 2 3\n");
  EXPECT_NE(refusal(infinite.table()), "");
}

TEST(GroundMesh, IsDrawnAsOneStaticBody) {
  const auto simulation =
      make_simulation(scene_of("[[ground.mesh]]\nhills_m = 2\nwidth_m = 100\ndepth_m = "
                               "100\n[[ball]]\nposition = [0, 9, 0]\n"));
  const FramePtr frame = after(*simulation, 3);
  ASSERT_EQ(frame->bodies.size(), 2u);
  EXPECT_EQ(frame->bodies[1].key, kGroundKey);
  EXPECT_TRUE(frame->bodies[1].is_static);
  std::size_t triangles = 0;
  for (const Instance& instance : frame->instances) {
    if (instance.body != 1) continue;
    const Mesh& mesh = *(*frame->meshes)[instance.mesh.value];
    triangles += mesh.indices.size() / 3;
    for (const Mesh::Vertex& vertex : mesh.vertices) {
      EXPECT_GT(vertex.normal.y(), 0.5f);
      EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
    }
  }
  EXPECT_EQ(triangles, 20000u);
  EXPECT_EQ(frame->report.counts.bodies, 1u);
}

constexpr const char* kWallOnAHill =
    "[ground]\nheight_m = -50\n"
    "[[ground.mesh]]\nhills_m = 1.5\nhill_length_m = 8\nwidth_m = 24\ndepth_m = 24\n"
    "rotation_deg = [14, 0, 0]\n"
    "[[solid]]\nstructure = \"box\"\nsize_m = [3, 4, 0.6]\nblock_m = 1\nposition = [0, -1.5, 0]\n"
    "anchored = \"bottom\"\nmaterial = \"concrete\"\n";

TEST(GroundMesh, SupportsPiecesAndDebrisOfAWallThatBreaksOnIt) {
  const std::string shot =
      "[script]\n[[script.shot]]\ntime_s = 0.1\nfrom = [0.2, 1.5, 6]\nat = [0.2, 1.2, 0]\n"
      "speed_m_s = 60\nradius_m = 0.4\n[[script.blast]]\ntime_s = 0.6\nat = [-0.5, 1.6, 0.7]\n"
      "radius_m = 3\nimpulse_Ns_m2 = 6000\ncover = true\n";
  const Scene scene = scene_of(kWallOnAHill + shot, {"draft", {}});
  const std::vector<Vec3> ground = scene.ground.meshes[0].vertices_W;
  /// Height of the nearest vertex; hills are smooth.
  const auto height_m = [&](const Vec3& at) {
    const auto apart = [&](const Vec3& v) {
      return (v - at).cwiseProduct(Vec3(1, 0, 1)).squaredNorm();
    };
    return std::ranges::min_element(ground, {}, apart)->y();
  };
  const auto on_it = [](const Vec3& at) {
    return std::max(std::abs(at.x()), std::abs(at.z())) < 10;
  };
  const auto simulation = make_simulation(scene);
  const FramePtr first = simulation->next();
  std::size_t breaks = 0;
  FramePtr frame;
  for (int i = 0; i < 150; ++i) {
    frame = simulation->next();
    breaks += frame->breaks.size();
    ASSERT_EQ(frame->report.failed, 0u);
    ASSERT_NEAR(frame->report.mass_kg, first->report.mass_kg, 1e-6 * first->report.mass_kg);
  }
  EXPECT_GE(breaks, 2u);
  std::size_t pieces = 0, chips = 0, below = 0;
  for (const FrameBody& body : frame->bodies) {
    if (body.is_static || !on_it(body.X_WB.position)) continue;
    EXPECT_GT(body.X_WB.position.y(), height_m(body.X_WB.position) - 0.5) << "body " << body.key;
    ++pieces;
  }
  for (const FrameDebris& chip : frame->debris) {
    const Vec3 at = chip.position_W.cast<double>();
    if (!on_it(at)) continue;
    ++chips;
    if (at.y() < height_m(at) - 0.5) ++below;
  }
  EXPECT_GT(pieces, 10u);
  EXPECT_GT(chips, 80u);
  EXPECT_LT(below, chips / 20) << "debris of the wall's foot, below the ground";
}

}  // namespace
}  // namespace sunder::scenes::ground_mesh_test
