// Tests that the appearances of a mesh file are in frames, before and after a break.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/geometry/polygon_mesh.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

/// Returns the texture coordinates at a point of the surface of the box below.
Vec2f uv_at(const Vec3& point) {
  return Vec2(point.x() + 2 * point.z(), point.y() - 3 * point.z()).cast<float>();
}

class MeshAppearances : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sunder-paint-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    setenv("SUNDER_CACHE", (folder_ / "cache").c_str(), 1);
    std::string text = "mtllib box.mtl\n";
    const ConvexPolyhedron box = make_box(Vec3(0, 0, 0), Vec3(1, 2, 1));
    for (const Vec3& v : box.vertices) {
      const Vec2f uv = uv_at(v);
      text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
              std::to_string(v.z()) + "\nvt " + std::to_string(uv.x()) + " " +
              std::to_string(uv.y()) + "\n";
    }
    for (std::size_t f = 0; f < box.faces.size(); ++f) {
      text += f % 2 == 0 ? "usemtl red\nf" : "usemtl blue\nf";
      for (const std::uint32_t v : box.face_corners(f)) {
        text += " " + std::to_string(v + 1) + "/" + std::to_string(v + 1);
      }
      text += "\n";
    }
    write("box.obj", text);
    write("box.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  }
  void TearDown() override {
    unsetenv("SUNDER_CACHE");
    fs::remove_all(folder_);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Scene load(const std::string& lines) const {
    return parse_scene("[scene]\ndescription = \"x\"\nduration_s = 0.4\n" + lines,
                       (folder_ / "scene.toml").string(), {});
  }

  fs::path folder_;
};

const std::string kBody = "[[body]]\nmesh = \"box.obj\"\n";
const std::string kShot =
    "material = \"stone\"\n[script]\n[[script.shot]]\ntime_s = 0.05\nfrom = [-3, 1, 0]\n"
    "at = [0, 1, 0]\nspeed_m_s = 60\nradius_m = 0.3\n";
const Vec3 kMiddle(0.5, 1, 0.5);

/// Returns the number of textured vertices. Expects normals that point away from the box's middle.
std::size_t count_textured_vertices(const Frame& frame) {
  std::size_t count = 0;
  for (const Instance& instance : frame.instances) {
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    for (const Mesh::Vertex& vertex : mesh.vertices) {
      if (vertex.look < Mesh::kFirstAppearance) continue;
      const Vec3 away = mesh.origin_T + vertex.position.cast<double>() - kMiddle;
      EXPECT_GT(vertex.normal.cast<double>().dot(away.normalized()), 0.9);
      ++count;
    }
  }
  return count;
}

TEST_F(MeshAppearances, AreInTheSceneOnceEach) {
  const Scene scene = load(kBody + kBody + "position = [5, 0, 0]\n");
  ASSERT_EQ(scene.appearances.size(), 2u);
  EXPECT_EQ(scene.appearances[0].color, Vec3f(1, 0, 0));
  EXPECT_EQ(scene.appearances[1].color, Vec3f(0, 0, 1));
  for (const Solid& solid : scene.solids) {
    for (const ConvexPtr& convex : solid.compound.convexes) {
      ASSERT_TRUE(convex->visual);
      for (const PolygonMesh::Face& face : convex->visual->faces)
        EXPECT_EQ(face.appearance != 0, face.id.none());
    }
  }
}

TEST_F(MeshAppearances, OfTwoBodiesShareTheirTextures) {
  write("box.mtl", "newmtl red\nmap_Kd a.png\nnewmtl blue\nmap_Kd b.png\n");
  write("a.png", "one");
  write("b.png", "two");
  const Scene scene = load(kBody + kBody + "position = [5, 0, 0]\n");
  ASSERT_EQ(scene.appearances.size(), 2u);
  EXPECT_NE(*scene.appearances[0].picture, *scene.appearances[1].picture);
}

TEST_F(MeshAppearances, ThatDifferInNormalMapOrRoughnessOnlyAreTwo) {
  const std::string same_color = "newmtl red\nKd 1 0 0\nnorm n.png\nnewmtl blue\nKd 1 0 0\n";
  write("n.png", "N");
  write("box.mtl", same_color);
  ASSERT_EQ(load(kBody).appearances.size(), 2u);
  write("box.mtl", same_color + "norm -bm 2 n.png\n");
  ASSERT_EQ(load(kBody).appearances.size(), 2u);
  write("box.mtl", same_color + "norm n.png\n");
  EXPECT_EQ(load(kBody).appearances.size(), 1u);
  write("box.mtl", same_color + "norm n.png\nPr 0.5\n");
  EXPECT_EQ(load(kBody).appearances.size(), 2u);
}

TEST_F(MeshAppearances, AreLeftOutIfTheBodyUsesTheLookOfItsMaterial) {
  const Scene scene = load(kBody + "look = \"material\"\n");
  EXPECT_TRUE(scene.appearances.empty());
  for (const ConvexPtr& convex : scene.solids.at(0).compound.convexes) {
    for (const PolygonMesh::Face& face : convex->visual->faces) EXPECT_EQ(face.appearance, 0u);
  }
}

TEST_F(MeshAppearances, AreNotInASolidMadeWithoutAScene) {
  const MeshSolid solid = make_mesh_solid((folder_ / "box.obj").string(), {});
  for (const ConvexPtr& convex : solid.compound.convexes) {
    ASSERT_TRUE(convex->visual);
    for (const PolygonMesh::Face& face : convex->visual->faces) EXPECT_EQ(face.appearance, 0u);
  }
}

TEST_F(MeshAppearances, HaveTheNormalsOfTheFileCutAndUncut) {
  // Adds the normals of a ball about the box's middle to its flat faces.
  std::ifstream given(folder_ / "box.obj");
  std::string text;
  for (std::string line; std::getline(given, line);) {
    if (line.starts_with("v ")) {
      std::istringstream numbers(line.substr(2));
      Vec3 at;
      numbers >> at.x() >> at.y() >> at.z();
      const Vec3 normal = at - kMiddle;
      line += "\nvn " + std::to_string(normal.x()) + " " + std::to_string(normal.y()) + " " +
              std::to_string(normal.z());
    }
    if (line.starts_with("f ")) {
      std::istringstream corners(line.substr(2));
      line = "f";
      for (std::string corner; corners >> corner;)
        line += " " + corner + corner.substr(corner.find('/'));
    }
    text += line + "\n";
  }
  write("box.obj", text);
  const auto simulation = make_simulation(load(kBody + kShot));
  std::size_t uncut = 0, cut = 0;
  FramePtr last;
  while (FramePtr frame = simulation->next()) {
    if (!last) uncut = count_textured_vertices(*frame);
    last = std::move(frame);
  }
  cut = count_textured_vertices(*last);
  EXPECT_GE(uncut, 24u);
  EXPECT_GT(cut, uncut);
}

TEST_F(MeshAppearances, StayOnTheOuterSurfaceThroughABreak) {
  const Scene scene = load(kBody + kShot);
  const auto simulation = make_simulation(scene);
  FramePtr last;
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  ASSERT_GT(last->bodies.size(), 10u) << "it breaks";
  ASSERT_TRUE(last->appearances);
  ASSERT_EQ(last->appearances->size(), 2u);
  const Box box{Vec3(0, 0, 0), Vec3(1, 2, 1)};
  std::size_t textured = 0, broken = 0;
  for (const Instance& instance : last->instances) {
    const Mesh& mesh = *(*last->meshes)[instance.mesh.value];
    if (scene.materials[mesh.material.value].name != "stone") continue;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3 at = mesh.origin_T + mesh.vertices[v].position.cast<double>();
      const Vec3 normal = mesh.vertices[v].normal.cast<double>();
      const Vec3 beyond = at + 1e-3 * normal;
      const bool outside =
          (beyond.array() < box.min.array()).any() || (beyond.array() > box.max.array()).any();
      ASSERT_NE(mesh.vertices[v].look, Mesh::kSurface)
          << "the file has an appearance for every face";
      if (mesh.vertices[v].look == Mesh::kInterior) {
        ++broken;
        continue;
      }
      ++textured;
      ASSERT_TRUE(outside);
      ASSERT_EQ(mesh.uvs.size(), mesh.vertices.size());
      ASSERT_LT((mesh.uvs[v] - uv_at(at)).norm(), 1e-4f) << "also on cut faces";
    }
  }
  EXPECT_GT(textured, 50u);
  EXPECT_GT(broken, textured) << "most faces of pieces are inside";
}

}  // namespace
}  // namespace sunder::scenes
