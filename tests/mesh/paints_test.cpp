// Tests of appearances from files: MTL with OBJ, and materials of glTF.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/mesh/mesh_reader.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

class Appearances : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "sunder-paints-XXXXXX").string();
    outside_ = mkdtemp(name.data());
    folder_ = outside_ / "meshes";
    fs::create_directories(folder_ / "pictures");
  }
  void TearDown() override { fs::remove_all(outside_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  RawMesh read(const std::string& name) const { return read_mesh(folder_ / name); }
  void expect_refused(const std::string& name, const std::string& why) const {
    try {
      read(name);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }

  fs::path outside_, folder_;
};

std::string text_of(const EncodedImage& picture) {
  std::string text;
  for (const std::byte b : *picture) text.push_back(static_cast<char>(b));
  return text;
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(Appearances, OfAnObjAreReadFromItsMtl) {
  write("a.mtl",
        "newmtl red clay\nKa 1 1 1\nKd 1 0.5 0\n"
        "newmtl brick\nKd 0 0 0\nmap_Kd -s 2 2 1 -clamp on pictures\\wall one.png\n"
        "newmtl odd\nKd spectral file.rfl\n");
  write("pictures/wall one.png", "PNG!");
  write("a.obj",
        "mtllib a.mtl\n" + kTriangle +
            "f 1 2 3\nusemtl red clay\nf 1 2 3\nusemtl brick\nf 1 2 3\nusemtl none\nf 1 2 3\n"
            "usemtl red clay\nf 3 2 1\n");
  const RawMesh mesh = read("a.obj");
  ASSERT_EQ(mesh.polygons.size(), 5u);
  EXPECT_EQ(mesh.polygons[0].group, RawMesh::kNoGroup);
  EXPECT_EQ(mesh.polygons[1].group, mesh.polygons[4].group);
  const auto appearance = [&](std::size_t polygon) {
    return mesh.groups[mesh.polygons[polygon].group].appearance;
  };
  ASSERT_TRUE(appearance(1));
  EXPECT_NEAR(appearance(1)->color.x(), 1, 1e-3);
  EXPECT_NEAR(appearance(1)->color.y(), 0.214, 2e-3) << "sRGB to linear";
  EXPECT_EQ(appearance(1)->color.z(), 0);
  EXPECT_FALSE(appearance(1)->picture);
  ASSERT_TRUE(appearance(2));
  ASSERT_TRUE(appearance(2)->picture);
  EXPECT_EQ(text_of(appearance(2)->picture), "PNG!");
  EXPECT_TRUE(appearance(2)->v_from_bottom);
  EXPECT_EQ(appearance(2)->color, Vec3f(1, 1, 1)) << "a black factor of a texture is ignored";
  EXPECT_FALSE(appearance(3));
}

TEST_F(Appearances, FilesMissingOrOutsideTheFolderAreIgnored) {
  std::ofstream(outside_ / "secret.png") << "PNG!";
  std::ofstream(outside_ / "secret.mtl") << "newmtl m\nKd 1 1 1\n";
  write("a.mtl", "newmtl m\nmap_Kd ../secret.png\nnewmtl n\nmap_Kd none.png\n");
  for (const std::string library : {"a.mtl", "none.mtl", "../secret.mtl"}) {
    write("a.obj", "mtllib " + library + "\n" + kTriangle + "usemtl m\nf 1 2 3\n");
    const RawMesh mesh = read("a.obj");
    const auto& appearance = mesh.groups.at(0).appearance;
    EXPECT_EQ(appearance.has_value(), library == "a.mtl") << library;
    if (appearance) {
      EXPECT_FALSE(appearance->picture);
    }
  }
}

TEST_F(Appearances, AnErrorInAnMtlNamesItsLine) {
  write("a.mtl", "newmtl m\nKd 1 red 0\n");
  write("a.obj", "mtllib a.mtl\n" + kTriangle + "usemtl m\nf 1 2 3\n");
  expect_refused("a.obj", "a.mtl:2: 'red' is not a number");
}

TEST_F(Appearances, OfAnMtlHaveANormalMapOrElseABumpMap) {
  write("a.mtl",
        "newmtl both\nnorm normals.png\nmap_Bump heights.png\n"
        "newmtl either\nmap_bump -s 2 2 1 -bm 0.25 heights.png\nnorm -bm 3 pictures\\n 2.png\n"
        "newmtl heights\nbump -bm 2 -imfchan l heights.png\n"
        "newmtl missing\nKd 1 1 1\nnorm none.png\n");
  write("normals.png", "N");
  write("pictures/n 2.png", "N2");
  write("heights.png", "H");
  std::string faces;
  for (const std::string name : {"both", "either", "heights", "missing"}) {
    faces += "usemtl " + name + "\nf 1 2 3\n";
  }
  write("a.obj", "mtllib a.mtl\n" + kTriangle + faces);
  const RawMesh mesh = read("a.obj");
  ASSERT_EQ(mesh.groups.size(), 4u);
  const auto relief = [&](std::size_t g) {
    const Appearance& appearance = *mesh.groups[g].appearance;
    return (appearance.relief ? text_of(appearance.relief) : "none") +
           std::to_string(appearance.normal_scale);
  };
  EXPECT_EQ(relief(0), "N1.000000");
  EXPECT_EQ(relief(1), "N23.000000");
  EXPECT_EQ(relief(2), "H2.000000");
  EXPECT_EQ(relief(3), "none1.000000");
  EXPECT_TRUE(mesh.groups[0].appearance->v_from_bottom);
  EXPECT_FALSE(mesh.groups[0].appearance->picture);

  write("a.mtl", "newmtl m\nnorm -bm steep normals.png\n");
  expect_refused("a.obj", "a.mtl:2: 'steep' is not a number");
}

TEST_F(Appearances, OfAnMtlHaveItsRoughnessOrOneFromItsExponent) {
  write("a.mtl",
        "newmtl said\nNs 1000\nPr 0.25\nPm 1\n"
        "newmtl exponent\nKs 0.5 0.5 0.5\nNs 30\n"
        "newmtl dull\nKs 0 0 0\nNs 30\n"
        "newmtl metal\nPm 2\n"
        "newmtl silent\nKd 1 1 1\nKs spectral file.rfl\n");
  std::string faces;
  for (const std::string name : {"said", "exponent", "dull", "metal", "silent"}) {
    faces += "usemtl " + name + "\nf 1 2 3\n";
  }
  write("a.obj", "mtllib a.mtl\n" + kTriangle + faces);
  const RawMesh mesh = read("a.obj");
  const auto gloss = [&](std::size_t g) { return mesh.groups.at(g).appearance->gloss; };
  EXPECT_EQ(gloss(0)->roughness, 0.25f);
  EXPECT_EQ(gloss(0)->metallic, 1);
  EXPECT_NEAR(gloss(1)->roughness, 0.5, 1e-6) << "the fourth root of 2 / (30 + 2)";
  EXPECT_EQ(gloss(1)->metallic, 0);
  EXPECT_FALSE(gloss(2)) << "black highlights have no exponent";
  EXPECT_EQ(gloss(3)->metallic, 1) << "at most";
  EXPECT_EQ(gloss(3)->roughness, 1);
  EXPECT_FALSE(gloss(4));

  write("a.mtl", "newmtl m\nKd 1 1 1\n\nPr smooth\n");
  expect_refused("a.obj", "a.mtl:4: 'smooth' is not a number");
}

TEST_F(Appearances, OfAGltfHaveItsNormalMapsAndTheirScale) {
  std::string points;
  for (const float f : {0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    points.append(reinterpret_cast<const char*>(&f), 4);
  }
  write("points.bin", points);
  write("n.png", "N");
  const auto gltf = [](const std::string& materials) {
    return R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"material":0},{"attributes":{"POSITION":0},"material":1},
{"attributes":{"POSITION":0},"material":2}]}],"materials":[)" +
           materials + R"(],"textures":[{"source":0},{"source":1}],
"images":[{"uri":"n.png"},{"uri":"none.png"}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"points.bin"}]})";
  };
  write("a.gltf", gltf(R"({"normalTexture":{"index":0,"scale":0.5}},
{"pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1],"roughnessFactor":0.5,"metallicFactor":-1,
"metallicRoughnessTexture":{"index":0}},"normalTexture":{"index":1}},
{"normalTexture":{"index":0,"texCoord":1}})"));
  const RawMesh mesh = read("a.gltf");
  const auto appearance = [&](std::size_t g) { return mesh.groups.at(g).appearance; };
  ASSERT_TRUE(appearance(0));
  EXPECT_EQ(text_of(appearance(0)->relief), "N");
  EXPECT_EQ(appearance(0)->normal_scale, 0.5f);
  EXPECT_EQ(appearance(0)->color, Vec3f(1, 1, 1)) << "the default of the format";
  EXPECT_FALSE(appearance(1)->relief) << "the file is missing";
  EXPECT_EQ(appearance(1)->color, Vec3f(0, 0, 1));
  EXPECT_EQ(appearance(0)->gloss->roughness, 1) << "the default of the format";
  EXPECT_EQ(appearance(0)->gloss->metallic, 1);
  EXPECT_FALSE(appearance(0)->gloss->picture);
  EXPECT_EQ(appearance(1)->gloss->roughness, 0.5f);
  EXPECT_EQ(appearance(1)->gloss->metallic, 0);
  EXPECT_EQ(appearance(1)->gloss->picture, appearance(0)->relief) << "one picture is read once";
  EXPECT_FALSE(appearance(2)->relief) << "uses a set of coordinates that is not read";

  write("a.gltf", gltf(R"({"normalTexture":{"index":0,"scale":"much"}},{},{})"));
  expect_refused("a.gltf", "a.gltf: scale must be a number");
  write("a.gltf", gltf(R"({"pbrMetallicRoughness":{"roughnessFactor":[1]}},{},{})"));
  expect_refused("a.gltf", "a.gltf: roughnessFactor must be a number");
}

TEST_F(Appearances, OfAGltfHaveItsBaseColoursAndTexturesFromAnySource) {
  std::string points;
  for (const float f : {0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    points.append(reinterpret_cast<const char*>(&f), 4);
  }
  write("points.bin", points + "JPEG");
  write("pictures/a b.png", "PNG!");
  std::string primitives;
  for (int material = 0; material < 6; ++material) {
    primitives += std::string(material == 0 ? "" : ",") +
                  R"({"attributes":{"POSITION":0},"material":)" + std::to_string(material) + "}";
  }
  write("a.gltf", R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[)" + primitives + R"(]}],
"materials":[
{"pbrMetallicRoughness":{"baseColorFactor":[0.25,0.5,1,1]}},
{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},
{"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}},
{"pbrMetallicRoughness":{"baseColorTexture":{"index":2}}},
{"pbrMetallicRoughness":{"baseColorTexture":{"index":3}}},
{"name":"a"}],
"textures":[{"source":0},{"source":1},{"source":2},{"source":3}],
"images":[{"uri":"pictures/a%20b.png"},{"uri":"data:image/png;base64,UE5HIQ=="},
{"bufferView":1,"mimeType":"image/jpeg"},{"uri":"../secret.png"}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":4}],
"buffers":[{"byteLength":40,"uri":"points.bin"}]})");
  const RawMesh mesh = read("a.gltf");
  ASSERT_EQ(mesh.groups.size(), 6u);
  const auto appearance = [&](std::size_t g) { return mesh.groups[g].appearance; };
  EXPECT_EQ(appearance(0)->color, Vec3f(0.25f, 0.5f, 1));
  EXPECT_EQ(text_of(appearance(1)->picture), "PNG!");
  EXPECT_EQ(text_of(appearance(2)->picture), "PNG!");
  EXPECT_EQ(text_of(appearance(3)->picture), "JPEG");
  EXPECT_FALSE(appearance(3)->v_from_bottom);
  ASSERT_TRUE(appearance(4));
  EXPECT_FALSE(appearance(4)->picture);
  EXPECT_FALSE(appearance(5)) << "the material has no appearance";
}

}  // namespace
}  // namespace sunder
