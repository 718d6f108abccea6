// Tests of the materials that a scene gives to the named parts of a mesh file.
#include <array>
#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "scenes/file/keys.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

class MeshMaterials : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sunder-names-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    setenv("SUNDER_CACHE", (folder_ / "cache").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("SUNDER_CACHE");
    fs::remove_all(folder_);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Scene load(const std::string& lines) const {
    return parse_scene("[scene]\ndescription = \"x\"\n" + lines, (folder_ / "scene.toml").string(),
                       {});
  }
  std::string refusal(const std::string& lines) const {
    try {
      load(lines);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }

  fs::path folder_;
};

/// Returns a box as OBJ with vertices numbered from `first`. `before` is put before its faces, and
/// `before_last` before the last face, the top.
std::string box_obj(const std::string& before, const Vec3& min, const Vec3& max, int first = 1,
                    const std::string& before_last = "") {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                      i & 4 ? max.z() : min.z());
    text += "v " + format(corner.x()) + " " + format(corner.y()) + " " + format(corner.z()) + "\n";
  }
  text += before;
  const std::array<std::array<int, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {0, 2, 3, 1}, {4, 5, 7, 6}, {2, 6, 7, 3}}};
  for (const auto& face : faces) {
    if (&face == &faces.back()) text += before_last;
    text += "f";
    for (const int corner : face) text += " " + std::to_string(first + corner);
    text += "\n";
  }
  return text;
}

/// Returns the volume of each material, in m³.
std::map<std::string, double> volumes_m3(const Scene& scene) {
  std::map<std::string, double> volumes;
  for (const Solid& solid : scene.solids) {
    for (const ConvexPtr& convex : solid.compound.convexes)
      volumes[scene.materials[convex->material.value].name] += convex->solid.volume_m3;
  }
  return volumes;
}

std::string table_and_leg() {
  return box_obj("o leg\nusemtl dark oak\n", {0, 0, 0}, {1, 2, 1}) +
         box_obj("o top\ng plate flat\nusemtl pale\n", {0, 2, 0}, {4, 3, 1}, 9);
}

TEST_F(MeshMaterials, ArePickedByObjectGroupOrTheFilesOwnMaterial) {
  write("table.obj", table_and_leg());
  for (const std::string names :
       {"leg = \"wood\", top = \"marble\"", "\"dark oak\" = \"wood\", plate = \"marble\"",
        "leg = \"wood\", flat = \"marble\", pale = \"brick\"", "leg = \"wood\""}) {
    const Scene scene = load(
        "[[body]]\nmesh = \"table.obj\"\nmaterial = \"marble\"\nmaterials = { " + names + " }\n");
    ASSERT_EQ(scene.solids.size(), 1u) << names << ": they touch";
    const auto volumes = volumes_m3(scene);
    ASSERT_EQ(volumes.size(), 2u) << names;
    EXPECT_NEAR(volumes.at("wood"), 2, 1e-9) << names;
    EXPECT_NEAR(volumes.at("marble"), 4, 1e-9) << names;
    const Compound& compound = scene.solids[0].compound;
    EXPECT_NEAR(mass_of(compound, scene.materials).mass_kg, 2 * 600 + 4 * 2700, 1e-5) << names;
  }
}

TEST_F(MeshMaterials, AreTheSameForAMeshAsAPartOfACompound) {
  write("table.obj", table_and_leg());
  const Scene scene = load(
      "[[solid]]\nstructure = \"compound\"\n[[solid.part]]\nstructure = \"mesh\"\n"
      "mesh = \"table.obj\"\nmaterials = { leg = \"wood\", top = \"glass\" }\nmirror = \"z\"\n"
      "position = [0, 0, 0.5]\n");
  const auto volumes = volumes_m3(scene);
  EXPECT_NEAR(volumes.at("wood"), 2 * 2, 1e-9) << "with its mirror image";
  EXPECT_NEAR(volumes.at("glass"), 2 * 4, 1e-9);
}

TEST_F(MeshMaterials, OfASurfaceWithSeveralAreThatOfTheLargestArea) {
  write("box.obj", box_obj("usemtl rough\n", {0, 0, 0}, {1, 8, 1}, 1, "usemtl fine\n"));
  const std::string named = "materials = { rough = \"stone\", fine = \"wood\" }\n";
  const auto whole = volumes_m3(load("[[body]]\nmesh = \"box.obj\"\nnodes = 1\n" + named));
  EXPECT_NEAR(whole.at("stone"), 8, 1e-9) << "its top is a small part of its surface";
  EXPECT_EQ(whole.size(), 1u);
}

TEST_F(MeshMaterials, OfPiecesWithoutSurfaceAreThoseOfTheirShell) {
  std::string text;
  for (int i = 0; i < 2; ++i) {
    const double x = 20.0 * i;
    text += box_obj(i == 0 ? "o a\n" : "o b\n", {x, 0, 0}, {x + 9, 9, 9}, 8 * i + 1);
  }
  write("cubes.obj", text);
  std::string nodes;  // one cell in the middle of each cube, and those around it
  for (const double x : {4.5, 24.5}) {
    for (const Vec3& to : {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(-3, 0, 0), Vec3(0, 3, 0),
                           Vec3(0, -3, 0), Vec3(0, 0, 3), Vec3(0, 0, -3)}) {
      const Vec3 node = Vec3(x, 4.5, 4.5) + to;
      nodes += format(node.x()) + " " + format(node.y()) + " " + format(node.z()) + "\n";
    }
  }
  write("nodes.txt", nodes);
  const Scene scene = load(
      "[[body]]\nmesh = \"cubes.obj\"\nnodes = \"nodes.txt\"\n"
      "materials = { a = \"wood\", b = \"glass\" }\n");
  const auto volumes = volumes_m3(scene);
  EXPECT_EQ(volumes.size(), 2u);
  EXPECT_NEAR(volumes.at("wood"), 729, 1e-6);
  EXPECT_NEAR(volumes.at("glass"), 729, 1e-6);
}

TEST_F(MeshMaterials, AreNotReadFromTheCacheForOtherNames) {
  write("table.obj", table_and_leg());
  const std::string body = "[[body]]\nmesh = \"table.obj\"\nmaterials = { ";
  EXPECT_EQ(volumes_m3(load(body + "leg = \"wood\" }\n")).count("wood"), 1u);
  EXPECT_NEAR(volumes_m3(load(body + "top = \"wood\" }\n")).at("wood"), 4, 1e-9);
  EXPECT_NEAR(volumes_m3(load(body + "top = \"brick\" }\n")).at("brick"), 4, 1e-9);
}

TEST_F(MeshMaterials, AreReadFromGltfNodesMeshesAndMaterials) {
  std::string points, order;
  const ConvexPolyhedron box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  for (std::size_t f = 0; f < box.faces.size(); ++f) {
    const auto corners = box.face_corners(f);
    for (const std::size_t k : {0, 1, 2, 0, 2, 3}) {
      for (const double c : box.vertices[corners[k]]) {
        const auto single = static_cast<float>(c);
        points.append(reinterpret_cast<const char*>(&single), 4);
      }
    }
  }
  std::ofstream(folder_ / "points.bin", std::ios::binary) << points;
  write("two.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"name":"low","mesh":0},{"name":"high","mesh":0,"translation":[0,1,0]}],
"materials":[{"name":"Granite"}],
"meshes":[{"name":"cube","primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":36}],
"bufferViews":[{"buffer":0,"byteLength":432}],"buffers":[{"byteLength":432,"uri":"points.bin"}]})");
  const auto with = [&](const std::string& names) {
    return volumes_m3(load("[[body]]\nmesh = \"two.gltf\"\nmaterials = { " + names + " }\n"));
  };
  const auto by_node = with("high = \"wood\", Granite = \"stone\"");
  EXPECT_NEAR(by_node.at("wood"), 1, 1e-6);
  EXPECT_NEAR(by_node.at("stone"), 1, 1e-6);
  EXPECT_NEAR(with("cube = \"glass\"").at("glass"), 2, 1e-6);
}

TEST_F(MeshMaterials, FaultsAreNamedWithTheirPlaceAndTheNamesOfTheFile) {
  write("table.obj", table_and_leg());
  write("plain.off",
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  const std::pair<const char*, const char*> faults[] = {
      {"mesh = \"table.obj\"\nmaterials = { lag = \"wood\" }",
       "table.obj: nothing in it is called 'lag'; did you mean 'leg'?; there are: dark oak, flat, "
       "leg, pale, plate, top"},
      {"mesh = \"table.obj\"\nmaterials = { leg = \"wod\" }",
       "scene.toml:5: unknown material 'wod'; did you mean 'wood'?"},
      {"mesh = \"table.obj\"\nmaterials = { leg = 3 }",
       "scene.toml:5: 'leg' in materials is the number 3; expected the name of a material"},
      {"mesh = \"table.obj\"\nmaterials = \"wood\"", "scene.toml:5: materials is"},
      {"mesh = \"plain.off\"\nmaterials = { leg = \"wood\" }",
       "OBJ and glTF files have names, of objects, groups and materials"},
      {"mesh = \"box:1,1,1\"\nmaterials = { leg = \"wood\" }", "is built in, and has no names"}};
  for (const auto& [lines, message] : faults) {
    const std::string got = refusal(std::string("[[body]]\n") + lines + "\n");
    EXPECT_NE(got.find(message), std::string::npos) << lines << "\n" << got;
  }
}

}  // namespace
}  // namespace sunder::scenes
