// Tests of files of other programs: each variant of a format is the same tetrahedron.
#include <gmock/gmock.h>

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"

namespace sunder {
namespace {

RawMesh parse(const std::string& text, MeshFormat format) {
  return parse_mesh(std::as_bytes(std::span(text)), format, "test");
}

void expect_tetrahedron(const std::string& text, MeshFormat format, const std::string& what) {
  const RepairedMesh mesh = repair_mesh(parse(text, format), what);
  ASSERT_EQ(mesh.shells.size(), 1u) << what;
  EXPECT_NEAR(mass_properties(mesh.shells[0]).volume_m3, 1.0 / 6, 1e-7) << what;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string text(values.size() * sizeof(T), '\0');
  std::memcpy(text.data(), std::data(values), text.size());
  return text;
}

const std::string kByteOrderMark = "\xef\xbb\xbf";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string kFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf \\\n1 4 3\nf 2 3 4\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\n";

TEST(MeshVariants, AnyLineEndingIsRead) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    expect_tetrahedron(replaced(kObj, "\n", end), MeshFormat::kObj, "obj");
    expect_tetrahedron(replaced("OFF\n4 4 0\n" + kPoints + kFaces, "\n", end), MeshFormat::kOff,
                       "off");
  }
}

TEST(MeshVariants, AByteOrderMarkIsIgnored) {
  expect_tetrahedron(kByteOrderMark + kObj, MeshFormat::kObj, "obj");
  expect_tetrahedron(kByteOrderMark + "OFF\n4 4 0\n" + kPoints + kFaces, MeshFormat::kOff, "off");
  expect_tetrahedron(kByteOrderMark + kPly +
                         "element face 4\nproperty list uchar int vertex_index\n" + "end_header\n" +
                         kPoints + kFaces,
                     MeshFormat::kPly, "ply");
}

TEST(MeshVariants, InvalidNormalsAreIgnored) {
  for (const std::string nan : {"nan", "-nan(ind)", "NaN", "-1.#IND", "inf"}) {
    const std::string obj =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 " + nan + "\nvt " + nan +
        "\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 1/1 4/1 3/1\nf 2/1/1 3/1/1 4/1/1\n";
    const RawMesh mesh = parse(obj, MeshFormat::kObj);
    EXPECT_TRUE(mesh.corner_normals.empty()) << nan;
    EXPECT_TRUE(mesh.corner_uvs.empty()) << nan;
    expect_tetrahedron(obj, MeshFormat::kObj, nan);
    const std::string nowhere = replaced(kObj, "v 1 0 0", "v 1 0 " + nan);
    EXPECT_THROW(parse(nowhere, MeshFormat::kObj), InputError);
  }
}

TEST(MeshVariants, PlyTriangleStripsAreTriangles) {
  const std::string strips =
      kPly + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + kPoints;
  expect_tetrahedron(strips + "9 0 2 1 3 -1 2 0 3 -1\n", MeshFormat::kPly, "two strips");
  expect_tetrahedron(strips + "6 0 2 1 3 0 2\n", MeshFormat::kPly, "one strip");
  EXPECT_THROW(parse(strips + "3 0 2 -2\n", MeshFormat::kPly), InputError);
}

TEST(MeshVariants, OffKeywordsAreReadInAnyOrderAndCase) {
  const std::string points = replaced(kPoints, "\n", " 0 0 1 255 0 0 255\n");
  for (const std::string keyword : {"CNOFF", "NCOFF", "ncoff"}) {
    expect_tetrahedron(keyword + "\n4 4 0\n" + points + kFaces, MeshFormat::kOff, keyword);
  }
  expect_tetrahedron("4 4 6\n" + kPoints + kFaces, MeshFormat::kOff, "no keyword");
  EXPECT_THROW(parse("4OFF\n4 4 0\n" + kPoints + kFaces, MeshFormat::kOff), InputError);
}

/// Returns the triangles of kObj as STL text, without normals.
std::string stl_text() {
  const char* const points[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string text = "solid tetrahedron\n";
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : face) text += std::string("vertex ") + points[v] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string stl_binary(const std::string& header, std::uint32_t count) {
  std::string file = header;
  file.resize(80, ' ');
  file += bytes({count});
  const RawMesh mesh = parse(stl_text(), MeshFormat::kStl);
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    file += std::string(12, '\0');
    for (const std::uint32_t v : mesh.polygon_corners(p)) {
      const Vec3f point = mesh.vertices[v].cast<float>();
      file += bytes({point.x(), point.y(), point.z()});
    }
    file += std::string(2, '\0');
  }
  return file;
}

TEST(MeshVariants, BinaryStlIsRecognizedWhateverItsFirstWord) {
  expect_tetrahedron(stl_text(), MeshFormat::kStl, "text");
  expect_tetrahedron(upper(stl_text()), MeshFormat::kStl, "capitals");
  expect_tetrahedron(stl_binary("made by someone", 4), MeshFormat::kStl, "binary");
  expect_tetrahedron(stl_binary("solid", 4), MeshFormat::kStl, "binary that says solid");
  expect_tetrahedron(stl_binary("solid", 4) + "\n\n", MeshFormat::kStl, "and has a tail");
  expect_tetrahedron(stl_binary("unknown count", 0), MeshFormat::kStl, "count unknown");
  EXPECT_THROW(parse(stl_binary("cut short", 5), MeshFormat::kStl), InputError);
}

/// Returns a glTF whose buffer has the tetrahedron's points, its indices, and two more points.
std::string gltf(const std::string& position_accessor, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":88,"uri":"data:;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
         "AAIBAAEDAAMCAQIDAgMAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw=="
         R"("}],"bufferViews":[{"buffer":0,"byteLength":48},)"
         R"({"buffer":0,"byteOffset":48,"byteLength":12},)"
         R"({"buffer":0,"byteOffset":60,"byteLength":4},)"
         R"({"buffer":0,"byteOffset":64,"byteLength":24}],"accessors":[)" +
         position_accessor +
         R"(,{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])" +
         more + "}";
}

TEST(MeshVariants, GltfAccessorsMayBeSparse) {
  const std::string whole = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
  expect_tetrahedron(gltf(whole), MeshFormat::kGltf, "whole");
  const std::string sparse =
      R"("componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,)"
      R"("indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":3}}})";
  expect_tetrahedron(gltf(R"({"bufferView":0,)" + sparse), MeshFormat::kGltf, "changed");
  const RawMesh flat = parse(gltf("{" + sparse), MeshFormat::kGltf);
  EXPECT_EQ(flat.vertices[1], Vec3(0, 0, 0));
  EXPECT_EQ(flat.vertices[2], Vec3(0, 1, 0));
  EXPECT_EQ(flat.vertices[3], Vec3(0, 0, 1));
  EXPECT_THROW(
      parse(gltf(replaced("{" + sparse, R"("count":4)", R"("count":3)")), MeshFormat::kGltf),
      InputError);
  EXPECT_THROW(
      parse(gltf(replaced("{" + sparse, R"("count":4)", R"("count":60000000)")), MeshFormat::kGltf),
      InputError);
}

TEST(MeshVariants, GltfExtensionsOfMaterialsAreIgnored) {
  const std::string whole = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
  const auto required = [&](const std::string& extension) {
    return gltf(whole, R"(,"extensionsRequired":[")" + extension + R"("])");
  };
  expect_tetrahedron(required("KHR_materials_specular"), MeshFormat::kGltf, "looks");
  EXPECT_THROW(parse(required("KHR_draco_mesh_compression"), MeshFormat::kGltf), InputError);
}

TEST(MeshVariants, ObjWithoutTheListsThatItsFacesNameIsRead) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces =
      "f 1/1/9 3/3/9 2/2/9\nf 1/1/8 2/2/8 4/4/8\nf 1//7 4//7 3//7\nf 2/2 3/3 4/4\n";
  expect_tetrahedron(points + faces, MeshFormat::kObj, "neither list");
  EXPECT_THROW(parse(points + "vt 0 0\n" + faces, MeshFormat::kObj), InputError);
  EXPECT_THROW(parse(points + "vn 0 0 1\n" + faces, MeshFormat::kObj), InputError);
  EXPECT_THROW(parse(points + "f 1 2 9\n", MeshFormat::kObj), InputError);
}

TEST(MeshVariants, GltfOfVersionOneIsNamed) {
  try {
    parse(R"({"asset":{"version":1},"buffers":{"b":{"byteLength":4,"uri":"data:;base64,AAAA"}}})",
          MeshFormat::kGltf);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("only version 2 of glTF is supported"));
  }
}

}  // namespace
}  // namespace sunder
