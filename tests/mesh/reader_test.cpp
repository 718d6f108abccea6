// Tests of mesh files in every format, their errors and limits, and of damaged files.
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/io/bytes.h"
#include "engine/io/mesh/mesh_reader.h"
#include "tests/mesh/mesh_files.h"

namespace sunder {
namespace {

std::vector<std::byte> to_bytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

RawMesh parse(const std::string& text, MeshFormat format) {
  return parse_mesh(to_bytes(text), format, "test");
}

template <class T>
std::string raw(T value, bool swap = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string message(const std::string& text, MeshFormat format) {
  try {
    parse(text, format);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string kObj =
    "# a quad and a triangle\n"
    "o first\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\r\nv 0 +1 0\n"
    "vt 0.5 0.25\nvn 0 0 1\n"
    "f 1/1/1 2//1 \\\n 3 4/1\n"
    "g second part\nf -4 -3 -2\n";

const std::string kOff =
    "OFF # comment\n4 2 0\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2\n";

const std::string kPly =
    "ply\nformat ascii 1.0\ncomment a quad\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property list uchar float texcoord\nend_header\n"
    "0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n1 1 0 0 0 1 9\n0 1 0 0 0 1 9\n"
    "4 0 1 2 3 2 0.5 0.5\n3 0 1 2 0\n";

const std::string kStl =
    "solid test\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
    "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\n"
    "vertex 0 1e0 0\nendloop\nendfacet\nendsolid test\n";

/// Returns kPly in binary, in one byte order.
std::string binary_ply(bool swap) {
  const std::string format = swap ? "binary_big_endian" : "binary_little_endian";
  std::string bytes = kPly.substr(0, kPly.find("end_header\n") + 11);
  bytes.replace(bytes.find("ascii"), 5, format);
  for (const auto& [x, y] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    bytes += raw(x, swap) + raw(y, swap) + raw(0.0, swap);
    bytes += raw(0.f, swap) + raw(0.f, swap) + raw(1.f, swap) + raw('\t');
  }
  bytes += raw('\4');
  for (int v = 0; v < 4; ++v) bytes += raw(v, swap);
  bytes += raw('\2') + raw(0.5f, swap) + raw(0.5f, swap) + raw('\3');
  for (int v = 0; v < 3; ++v) bytes += raw(v, swap);
  return bytes + raw('\0');
}

std::string binary_stl() {
  std::string bytes = "solid although binary";
  bytes.resize(80, ' ');
  bytes += raw(std::uint32_t{1});
  for (const float f : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f})
    bytes += raw(f);
  return bytes + raw(std::uint16_t{0});
}

/// Returns a triangle with normals under a node that doubles and moves it; buffer in base 64.
std::string gltf(const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[0,0,5]},{"mesh":0,"scale":[2,2,-2]}],
"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
{"bufferView":1,"componentType":5123,"type":"SCALAR","count":3}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"byteLength":42)" +
         buffer + "}]}";
}

std::string triangle_bytes() {
  std::string bytes;
  for (const float f : {0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes += raw(f);
  for (const std::uint16_t v : {0, 1, 2}) bytes += raw(v);
  return bytes;
}

std::string to_base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) text += digits[bits >> (held - 6) & 63];
  }
  return text;
}

std::string embedded_gltf() {
  return gltf(R"(,"uri":"data:application/octet-stream;base64,)" + to_base64(triangle_bytes()) +
              "\"");
}

std::string glb() {
  std::string json = gltf("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary = triangle_bytes();
  binary.resize(44, '\0');
  const auto size = [](std::size_t n) { return raw(static_cast<std::uint32_t>(n)); };
  return "glTF" + size(2) + size(28 + json.size() + binary.size()) + size(json.size()) + "JSON" +
         json + size(binary.size()) + std::string("BIN\0", 4) + binary;
}

TEST(MeshReader, ObjKeepsPolygonsGroupsAndAttributes) {
  const RawMesh mesh = parse(kObj, MeshFormat::kObj);
  ASSERT_EQ(mesh.polygons.size(), 2u);
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].names, std::vector<std::string>{"first"});
  EXPECT_EQ(mesh.groups[1].names, (std::vector<std::string>{"second", "part", "first"}));
  EXPECT_EQ(mesh.polygons[1].group, 1u);
  EXPECT_EQ(mesh.corner_normals[1], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.corner_normals[2], Vec3f(0, 0, 0));
  EXPECT_EQ(mesh.corner_uvs[0], Vec2f(0.5f, 0.25f));
}

TEST(MeshReader, OffKeepsPolygons) {
  const RawMesh mesh = parse(kOff, MeshFormat::kOff);
  EXPECT_EQ(mesh.vertices[2], Vec3(1, 1, 0));
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
  const RawMesh with_normals =
      parse("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n", MeshFormat::kOff);
  EXPECT_EQ(with_normals.corner_normals[2], Vec3f(0, 0, 1));
}

TEST(MeshReader, PlyIsTheSameInTextAndInEitherByteOrder) {
  const RawMesh text = parse(kPly, MeshFormat::kPly);
  EXPECT_EQ(text.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
  EXPECT_EQ(text.corner_normals[3], Vec3f(0, 0, 1));
  for (const bool swap : {false, true}) {
    const RawMesh binary = parse(binary_ply(swap), MeshFormat::kPly);
    EXPECT_EQ(binary.vertices, text.vertices);
    EXPECT_EQ(binary.corners, text.corners);
    EXPECT_EQ(binary.corner_normals, text.corner_normals);
  }
}

TEST(MeshReader, StlIsReadInTextAndInBinary) {
  EXPECT_EQ(parse(kStl, MeshFormat::kStl).polygons.size(), 2u);
  const RawMesh binary = parse(binary_stl(), MeshFormat::kStl);
  ASSERT_EQ(binary.polygons.size(), 1u);
  EXPECT_EQ(binary.vertices[2], Vec3(1, 1, 0));
}

TEST(MeshReader, GltfNodesPlaceTheirMeshes) {
  for (const std::string& text : {embedded_gltf(), glb()}) {
    const RawMesh mesh = parse(text, MeshFormat::kGltf);
    ASSERT_EQ(mesh.polygons.size(), 1u);
    EXPECT_EQ(mesh.vertices[0], Vec3(0, 0, 3));  // Doubled, mirrored, and moved by 5.
    EXPECT_EQ(mesh.vertices[1], Vec3(2, 0, 5));
    // The mirrored triangle is reversed.
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 2, 1}));
    EXPECT_EQ(mesh.corner_normals[0], Vec3f(0, 0, -1));
    ASSERT_EQ(mesh.groups.size(), 1u);
    EXPECT_EQ(mesh.groups[0].names, std::vector<std::string>{"tri"});
  }
}

TEST(MeshReader, ErrorsNameTheFileAndTheLine) {
  EXPECT_EQ(
      message("v 0 0 0\nf 1 2 3\n", MeshFormat::kObj).rfind("test:2: there is no vertex 3", 0), 0u);
  EXPECT_EQ(message("v 0 zero 0\n", MeshFormat::kObj).rfind("test:1: 'zero' is not a number", 0),
            0u);
  EXPECT_EQ(message("f 0 1 2\n", MeshFormat::kObj).rfind("test:1: there is no vertex 0", 0), 0u);
  EXPECT_NE(message("OFF\n3 1 0\n0 0 0\n", MeshFormat::kOff).find("cut short"), std::string::npos);
  EXPECT_NE(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", MeshFormat::kOff).find("test:6"),
            std::string::npos);
  EXPECT_NE(message("", MeshFormat::kObj).find("no faces"), std::string::npos);
  EXPECT_NE(message("v nan 0 0\n", MeshFormat::kObj).find("is not a number"), std::string::npos);
  EXPECT_NE(message("v 1e999 0 0\n", MeshFormat::kObj).find("'1e999' is too large"),
            std::string::npos);
  EXPECT_NE(message("v 1e200 0 0\nf 1 1 1\n", MeshFormat::kObj).find("1e9 m"), std::string::npos);
  std::string ply = binary_ply(false);
  ply.replace(ply.find("end_header\n") + 15, 4, raw(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_NE(message(ply, MeshFormat::kPly).find("vertex 1 is not within"), std::string::npos);
  EXPECT_THROW(read_mesh("model.fbx"), InputError);
  EXPECT_THROW(read_mesh("missing.obj"), InputError);
}

TEST(MeshReader, LimitsAreKept) {
  const MeshLimits few{.bytes = 1000, .vertices = 3, .corners = 100};
  EXPECT_THROW(parse_mesh(to_bytes(kObj), MeshFormat::kObj, "test", few), InputError);
  const MeshLimits small{.bytes = 10};
  EXPECT_THROW(parse_mesh(to_bytes(kObj), MeshFormat::kObj, "test", small), InputError);
  // Counts that no file of this size can have cost neither memory nor time.
  for (const char* count : {"4000000000", "99999999999999", "-1"}) {
    std::string ply = kPly, off = kOff;
    ply.replace(ply.find("vertex 4") + 7, 1, count);
    off.replace(off.find("4 2 0"), 1, count);
    EXPECT_THROW(parse(ply, MeshFormat::kPly), InputError);
    EXPECT_THROW(parse(off, MeshFormat::kOff), InputError);
  }
}

TEST(MeshReader, AGltfReadsNothingOutsideItsFolder) {
  for (const char* uri :
       {"/etc/passwd", "../secret.bin", "a/../../b", "http://x/y", "missing.bin"}) {
    EXPECT_THROW(parse(gltf(",\"uri\":\"" + std::string(uri) + "\""), MeshFormat::kGltf),
                 InputError);
  }
}

/// Damages a file by up to three random edits.
std::string mutated(std::string bytes, Random& random) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  for (std::uint32_t i = 0, n = 1 + random.below(3); i < n && !bytes.empty(); ++i) {
    const std::size_t at = random.below(size) % bytes.size();
    switch (random.below(6)) {
      case 0:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes.resize(at);
        break;
      case 2:
        bytes.insert(at, bytes.substr(random.below(size) % bytes.size(), 1 + random.below(40)));
        break;
      case 3:
        bytes.erase(at, 1 + random.below(20));
        break;
      case 4:
        bytes.insert(at, std::string(1 + random.below(20), '9'));
        break;
      default:
        bytes[at] = "-/\\#\n\r .e\"{}[],\xff"[random.below(17)];
    }
  }
  return bytes;
}

class Damaged : public testing::TestWithParam<std::pair<MeshFormat, std::string>> {};

TEST_P(Damaged, EndsWithAMeshOrAnError) {
  Random random(7);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    try {
      const RawMesh mesh = parse(mutated(GetParam().second, random), GetParam().first);
      for (const std::uint32_t v : mesh.corners) ASSERT_LT(v, mesh.vertices.size());
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("test:", 0), 0u) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 400);
}

INSTANTIATE_TEST_SUITE_P(MeshReader, Damaged,
                         testing::Values(std::pair{MeshFormat::kObj, kObj},
                                         std::pair{MeshFormat::kOff, kOff},
                                         std::pair{MeshFormat::kPly, kPly},
                                         std::pair{MeshFormat::kPly, binary_ply(false)},
                                         std::pair{MeshFormat::kPly, binary_ply(true)},
                                         std::pair{MeshFormat::kStl, kStl},
                                         std::pair{MeshFormat::kStl, binary_stl()},
                                         std::pair{MeshFormat::kGltf, embedded_gltf()},
                                         std::pair{MeshFormat::kGltf, glb()}));

TEST(MeshReader, MadeAndRealMeshesAreRead) {
  for (const std::string set : {"good", "nasty"}) {
    for (const auto& file : test::meshes(set)) {
      const std::string name = file.filename().string();
      if (name == "malformed.obj" || name == "empty.obj") {
        EXPECT_THROW(read_mesh(file), InputError) << name;
      } else {
        EXPECT_GT(read_mesh(file).polygons.size(), 0u) << name;
      }
    }
  }
  for (const std::string& name : test::good_names()) {
    const RawMesh read = read_mesh(test::made_file(name)), made = test::make_good(name);
    EXPECT_EQ(read.vertices, made.vertices) << name;
    EXPECT_EQ(read.corners, made.corners) << name;
    EXPECT_EQ(read.polygons.size(), made.polygons.size()) << name;
  }
}

}  // namespace
}  // namespace sunder
