// Tests that flush boxes of a file are one solid, with and without texture coordinates.
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/repair/repair.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/adjacency/compound_builder.h"
#include "fracture/vacd/vacd.h"
#include "tests/fracture/break_compound.h"

namespace sunder {
namespace {

/// Returns the faces of boxes as quads that share no vertices, as exporters write textured meshes.
std::vector<std::array<Vec3, 4>> quads(const std::vector<Box>& boxes) {
  std::vector<std::array<Vec3, 4>> all;
  for (const Box& box : boxes) {
    const ConvexPolyhedron solid = make_box(box.min, box.max);
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      std::array<Vec3, 4>& quad = all.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) quad[k] = solid.vertices[solid.face_corners(f)[k]];
    }
  }
  return all;
}

std::vector<std::byte> obj(const std::vector<Box>& boxes, bool textured) {
  std::string text = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  for (const auto& quad : quads(boxes)) {
    for (const Vec3& corner : quad) {
      text += "v";
      for (int i = 0; i < 3; ++i) text += " " + std::to_string(corner[i]);
      text += "\n";
    }
    text += textured ? "f -4/1 -3/2 -2/3 -1/4\n" : "f -4 -3 -2 -1\n";
  }
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

/// Returns a GLB file of triangles.
std::vector<std::byte> glb(const std::vector<Box>& boxes, bool textured) {
  std::string places, uvs, indices;
  const auto put = [](std::string& to, auto value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  std::uint32_t count = 0;
  for (const auto& quad : quads(boxes)) {
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 3; ++i) {
        put(places, static_cast<float>(quad[static_cast<std::size_t>(k)][i]));
      }
      put(uvs, k == 1 || k == 2 ? 1.f : 0.f);
      put(uvs, k >= 2 ? 1.f : 0.f);
    }
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) put(indices, count + k);
    count += 4;
  }
  const auto text = [](std::size_t n) { return std::to_string(n); };
  const std::string binary = places + uvs + indices;
  const auto view = [&](std::size_t from, std::size_t size) {
    return R"({"buffer":0,"byteOffset":)" + text(from) + R"(,"byteLength":)" + text(size) + "}";
  };
  const std::string of = R"(,"componentType":5126,"count":)" + text(count);
  std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"indices":0,"attributes":{"POSITION":1)" +
      std::string(textured ? R"(,"TEXCOORD_0":2)" : "") +
      R"(}}]}],"accessors":[{"bufferView":2,"componentType":5125,"type":"SCALAR","count":)" +
      text(count / 4 * 6) + R"(},{"bufferView":0,"type":"VEC3")" + of +
      R"(},{"bufferView":1,"type":"VEC2")" + of + R"(}],"bufferViews":[)" + view(0, places.size()) +
      "," + view(places.size(), uvs.size()) + "," +
      view(places.size() + uvs.size(), indices.size()) + R"(],"buffers":[{"byteLength":)" +
      text(binary.size()) + "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  const auto size = [&](std::size_t n) { put(file, static_cast<std::uint32_t>(n)); };
  size(2), size(28 + json.size() + binary.size()), size(json.size());
  file += "JSON" + json;
  size(binary.size());
  file += std::string("BIN\0", 4) + binary;
  const auto* begin = reinterpret_cast<const std::byte*>(file.data());
  return {begin, begin + file.size()};
}

struct Variant {
  const char* name;
  MeshFormat format;
  std::vector<std::byte> (*write)(const std::vector<Box>&, bool textured);
  bool textured;
};
const Variant kVariants[] = {{"obj", MeshFormat::kObj, obj, false},
                             {"obj with vt", MeshFormat::kObj, obj, true},
                             {"glTF", MeshFormat::kGltf, glb, false},
                             {"glTF with texture coordinates", MeshFormat::kGltf, glb, true}};

/// Returns a compound of one convex per box.
Compound compound_of(const std::vector<Box>& boxes, const Variant& variant) {
  RawMesh mesh = parse_mesh(variant.write(boxes, variant.textured), variant.format, variant.name);
  fracture::VacdOptions options;
  options.node_count = static_cast<std::uint32_t>(boxes.size());
  return fracture::decompose(repair_mesh(std::move(mesh), variant.name), options).compound;
}

TEST(FlushBoxes, AreOneSolidWithTextureCoordinatesOrWithout) {
  for (const Variant& variant : kVariants) {
    const Compound pair = compound_of({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}}, variant);
    EXPECT_EQ(pair.convexes[0]->is_internal(), !variant.textured) << variant.name;
    ASSERT_EQ(pair.bonds.size(), 1u) << variant.name;
    EXPECT_NEAR(pair.bonds[0].area_m2, 1, 1e-12) << variant.name;
    EXPECT_EQ(fracture::split_islands(pair).size(), 1u) << variant.name;
    EXPECT_NEAR(volume(pair), 2, 1e-12) << variant.name;
  }
}

TEST(FlushBoxes, TouchWhereTheyOverlap) {
  for (const Variant& variant : kVariants) {
    // A slab on two piers; half of the right one's width is beside the slab.
    const Compound portal = compound_of({{{0, 0, 0}, {0.5, 2, 1}},
                                         {{2.75, 0, 0}, {3.25, 2, 1}},
                                         {{0, 2, 0}, {3, 2.25, 1}},
                                         {{5, 0, 0}, {6, 1, 1}}},
                                        variant);
    ASSERT_EQ(portal.bonds.size(), 2u) << variant.name;
    EXPECT_NEAR(portal.bonds[0].area_m2, 0.5, 1e-12) << variant.name;
    EXPECT_NEAR(portal.bonds[1].area_m2, 0.25, 1e-12) << variant.name;
    EXPECT_EQ(fracture::split_islands(portal).size(), 2u) << variant.name << ": one stands apart";
  }
}

TEST(FlushBoxes, OnlyCoveredFacesBecomeInterior) {
  const Compound pair = compound_of({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 2, 1}}}, kVariants[3]);
  std::vector<std::size_t> inner;
  for (const ConvexPtr& convex : pair.convexes) {
    inner.push_back(0);
    for (const PolygonMesh::Face& face : convex->visual->faces) {
      inner.back() += face.kind == FaceKind::kInterior ? 1 : 0;
    }
    EXPECT_EQ(open_edges(*convex->visual), 0u);
    EXPECT_EQ(convex->visual->faces.size(), 11u) << "two triangles a side, but one cap";
  }
  EXPECT_EQ(inner, (std::vector<std::size_t>{1, 0}));
}

/// Returns a break by 40 Voronoi cells around a point.
BreakCommand break_at(const Vec3& point_R, double radius_m) {
  BreakCommand command;
  command.event = command.seed = 1;
  command.pattern.kind = PatternSpec::Kind::kVoronoi;
  command.pattern.cells = 40;
  command.X_RP.position = point_R;
  command.radius_m = radius_m;
  return command;
}

TEST(FlushBoxes, StayBondedAfterABreakBesideThem) {
  const BreakCommand command = break_at(Vec3(2, 2, 0.5), 0.6);
  for (const Variant& variant : kVariants) {
    const Compound pair = compound_of({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 2, 1}}}, variant);
    const BreakPlan plan = fracture::break_compound(pair, command);
    ASSERT_GT(plan.pieces.size(), 1u) << variant.name;
    EXPECT_EQ(plan.failed, 0u) << variant.name;
    double sum = plan.debris_volume_m3, held_m2 = 0;
    for (const Compound& piece : plan.pieces) sum += volume(piece);
    EXPECT_NEAR(sum, 3, 1e-9) << variant.name;
    for (const Bond& bond : plan.pieces[0].bonds) {
      const Compound& rest = plan.pieces[0];
      const Box a = rest.convexes[bond.a]->box, b = rest.convexes[bond.b]->box;
      const bool across =
          std::abs(a.max.x() - b.min.x()) < 1e-9 || std::abs(b.max.x() - a.min.x()) < 1e-9;
      if (across && std::abs(std::min(a.max.x(), b.max.x()) - 1) < 1e-9) held_m2 += bond.area_m2;
    }
    EXPECT_NEAR(held_m2, 1, 1e-9) << variant.name;
  }
}

/// Returns two boxes side by side; the larger one's side at x = 1, which the smaller one touches,
/// is uneven by a tenth of a micrometre.
Compound uneven_pair() {
  const std::vector<Box> boxes = {{{0, 0, 0}, {1, 1, 1}}, {{1, -1, -1}, {2, 2, 2}}};
  RawMesh mesh = parse_mesh(obj(boxes, true), MeshFormat::kObj, "pair");
  for (Vec3& vertex : mesh.vertices) {
    if (vertex.x() == 1 && vertex.y() * vertex.z() == -2) vertex.x() += 5e-8;
  }
  fracture::VacdOptions options;
  options.node_count = 2;
  return fracture::decompose(repair_mesh(std::move(mesh), "pair"), options).compound;
}

TEST(FlushBoxes, AreCutWhereTheSideTheyShareIsUneven) {
  const Compound pair = uneven_pair();
  ASSERT_EQ(pair.bonds.size(), 1u);
  const BreakCommand command = break_at(Vec3(1.5, 0.5, 0.5), 2);
  const BreakPlan plan = fracture::break_compound(pair, command);
  EXPECT_EQ(plan.failed, 0u);
  EXPECT_GT(plan.pieces.size(), 10u);
  double sum = plan.debris_volume_m3;
  for (const Compound& piece : plan.pieces) sum += volume(piece);
  EXPECT_NEAR(sum, volume(pair), 1e-5);
}

}  // namespace
}  // namespace sunder
