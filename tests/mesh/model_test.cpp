// Tests of exports: triangulation of faces with holes, and GLB and OBJ files.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/geometry/repair/repair.h"
#include "engine/geometry/triangulate_face.h"
#include "engine/io/bytes.h"
#include "engine/io/mesh/export_model.h"
#include "engine/io/mesh/glb_writer.h"
#include "engine/io/mesh/mesh_reader.h"
#include "engine/io/mesh/obj_writer.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / "sunder-model-test-XXXXXX") {
    std::string name = path_.string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// Returns one face in z = 0; its first contour is counter-clockwise, holes are clockwise.
PolygonMesh flat(const std::vector<std::vector<Vec2>>& contours) {
  PolygonMesh mesh;
  for (const auto& contour : contours) {
    mesh.contours.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                             static_cast<std::uint32_t>(contour.size())});
    for (const Vec2& p : contour) {
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.corner_normals.push_back(Vec3f::UnitZ());
      mesh.vertices.emplace_back(p.x(), p.y(), 0);
    }
  }
  mesh.faces.push_back({Plane{Vec3::UnitZ(), 0}, PlaneId{}, 0,
                        static_cast<std::uint32_t>(contours.size()), FaceKind::kSurface});
  return mesh;
}

/// Returns the area of all triangles, or −1 if a triangle is reversed.
double covered_area(const PolygonMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : triangulate(mesh, 0)) {
    const Vec3 &a = mesh.vertices[mesh.corners[t[0]]], &b = mesh.vertices[mesh.corners[t[1]]],
               &c = mesh.vertices[mesh.corners[t[2]]];
    const double area = 0.5 * (b - a).cross(c - a).z();
    if (area < -1e-15) return -1;
    sum += area;
  }
  return sum;
}

const std::vector<Vec2> kSquare = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};

TEST(TriangulateFace, CoversAFaceThatIsNotConvex) {
  EXPECT_NEAR(
      covered_area(flat({{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {4, 3}, {4, 4}, {0, 4}}})), 10,
      1e-12);
}

TEST(TriangulateFace, LeavesHolesOut) {
  const std::vector<Vec2> low = {{1, 1}, {1, 2}, {2, 2}, {2, 1}};
  const std::vector<Vec2> high = {{2.5, 2.5}, {2.5, 3.5}, {3.5, 3.5}, {3.5, 2.5}};
  EXPECT_NEAR(covered_area(flat({kSquare, low})), 15, 1e-12);
  EXPECT_NEAR(covered_area(flat({kSquare, low, high})), 14, 1e-12);
  EXPECT_EQ(triangulate(flat({kSquare, low, high}), 0).size(), 4 + 4 + 4 - 2 + 2 * 2u);
}

TEST(TriangulateFace, CoversAnIslandInAHole) {
  const std::vector<Vec2> hole = {{1, 1}, {1, 3}, {3, 3}, {3, 1}};
  const std::vector<Vec2> island = {{1.5, 1.5}, {2.5, 1.5}, {2.5, 2.5}, {1.5, 2.5}};
  EXPECT_NEAR(covered_area(flat({kSquare, hole, island})), 16 - 4 + 1, 1e-12);
}

TEST(TriangulateFace, EveryEdgeOfTheContoursIsAnEdgeOfOneTriangle) {
  const std::vector<Vec2> hole = {{1, 1}, {1, 2}, {2, 2}, {2, 1}};
  const PolygonMesh mesh = flat({kSquare, hole});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : triangulate(mesh, 0)) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  }
  for (std::uint32_t first : {0u, 4u}) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::pair edge{first + i, first + (i + 1) % 4};
      EXPECT_EQ(std::count(edges.begin(), edges.end(), edge), 1) << edge.first;
    }
  }
}

/// Returns two boxes, the second with one interior face.
std::vector<Compound> two_pieces() {
  std::vector<Compound> pieces;
  for (const double x : {0.0, 1.0}) {
    ConvexPolyhedron shape = make_box({x, 0, 0}, {x + 1, 2, 3});
    if (x > 0) shape.faces[0].kind = FaceKind::kInterior;
    pieces.push_back({{make_convex(shape, MaterialIndex(0u))}, {0}, {}, {}});
  }
  return pieces;
}

std::vector<Material> stone() {
  Material material;
  material.name = "old stone";
  return {material};
}

double enclosed_volume(const RepairedMesh& mesh) {
  double sum = 0;
  for (const PolygonMesh& shell : mesh.shells) sum += mass_properties(shell).volume_m3;
  return sum;
}

TEST(Glb, ReadsBackAsTheSameClosedSolids) {
  const Folder folder;
  write_glb(folder / "x.glb", make_model(two_pieces(), stone(), 0));
  RawMesh raw = read_mesh(folder / "x.glb");
  EXPECT_EQ(raw.polygons.size(), 24u);
  ASSERT_EQ(raw.corner_normals.size(), raw.corners.size());
  for (std::size_t p = 0; p < raw.polygons.size(); ++p) {
    const auto corners = raw.polygon_corners(p);
    const Vec3 normal = (raw.vertices[corners[1]] - raw.vertices[corners[0]])
                            .cross(raw.vertices[corners[2]] - raw.vertices[corners[0]])
                            .normalized();
    const Vec3f stored = raw.corner_normals[raw.polygons[p].first_corner];
    EXPECT_NEAR(normal.dot(stored.cast<double>()), 1, 1e-6);
  }
}

TEST(Glb, MovesPiecesApartWhenExploded) {
  const Folder folder;
  write_glb(folder / "x.glb", make_model(two_pieces(), stone(), 2));
  const RepairedMesh mesh = repair_mesh(read_mesh(folder / "x.glb"), "x", {});
  ASSERT_EQ(mesh.shells.size(), 2u);
  EXPECT_NEAR(enclosed_volume(mesh), 12, 1e-5);
  EXPECT_NEAR(bounds(mesh.shells[1]).min.x() - bounds(mesh.shells[0]).max.x(), 2, 1e-6);
}

TEST(Glb, FollowsTheRulesOfTheFormat) {
  const Folder folder;
  write_glb(folder / "x.glb", make_model(two_pieces(), stone(), 0));
  const std::vector<std::byte> bytes = read_file(folder / "x.glb");
  ByteReader in(bytes, "x.glb");
  EXPECT_EQ(in.take<std::uint32_t>(), 0x46546c67u);
  EXPECT_EQ(in.take<std::uint32_t>(), 2u);
  EXPECT_EQ(in.take<std::uint32_t>(), bytes.size());
  const auto json_size = in.take<std::uint32_t>();
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(in.take<std::uint32_t>(), 0x4e4f534au);
  std::string text(json_size, ' ');
  for (char& c : text) c = in.take<char>();
  const nlohmann::json document = nlohmann::json::parse(text);
  const auto binary_size = in.take<std::uint32_t>();
  EXPECT_EQ(binary_size % 4, 0u);
  EXPECT_EQ(document["asset"]["version"], "2.0");
  EXPECT_EQ(document["buffers"][0]["byteLength"], binary_size);
  EXPECT_EQ(document["nodes"].size(), 2u);
  EXPECT_EQ(document["meshes"][0]["primitives"].size(), 1u);
  EXPECT_EQ(document["meshes"][1]["primitives"].size(), 2u) << "one face is interior";
  EXPECT_EQ(document["materials"][1]["name"], "old stone inside");
  for (const auto& accessor : document["accessors"]) {
    const auto& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t item =
        view.contains("byteStride") ? view["byteStride"].get<std::size_t>() : 4;
    EXPECT_LE(
        accessor["byteOffset"].get<std::size_t>() + item * accessor["count"].get<std::size_t>(),
        view["byteLength"].get<std::size_t>());
  }
}

EncodedImage bytes_of(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return std::make_shared<const std::vector<std::byte>>(begin, begin + text.size());
}

TEST(Glb, KeepsAppearancesWithTheirTexturesAndCoordinates) {
  const EncodedImage png = bytes_of("\x89PNG5"), jpeg = bytes_of("\xff\xd8\xff"),
                     other = bytes_of("N");
  const std::vector<Appearance> appearances = {
      {Vec3f(1, 0.5f, 0.25f), png, true, other, 0.5f, MetallicRoughness{0.25f, 1, jpeg}},
      {Vec3f(0, 0, 1), jpeg, false, png, -2}};
  std::vector<Compound> pieces = two_pieces();
  for (Compound& piece : pieces) {
    const auto convex = std::make_shared<Convex>(*piece.convexes[0]);
    PolygonMesh mesh = polygon_mesh(convex->polyhedron);
    for (const std::uint32_t corner : mesh.corners) {
      const Vec3& at = mesh.vertices[corner];
      mesh.corner_uvs.emplace_back(static_cast<float>(at.x() + 4 * at.z()),
                                   static_cast<float>(at.y()));
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) mesh.faces[f].appearance = f % 3;
    convex->visual = std::make_shared<const PolygonMesh>(std::move(mesh));
    piece.convexes[0] = convex;
  }
  const Folder folder;
  write_glb(folder / "x.glb", make_model(pieces, stone(), 0, appearances));
  const RawMesh read = read_mesh(folder / "x.glb");
  std::size_t seen[3] = {};
  for (const RawMesh::Polygon& polygon : read.polygons) {
    const RawMesh::Group& group = read.groups.at(polygon.group);
    const std::string& name = group.names.back();
    const std::size_t number = name == "appearance 1" ? 1 : name == "appearance 2" ? 2 : 0;
    ++seen[number];
    if (number == 0) {
      EXPECT_FALSE(group.appearance->picture);
      continue;
    }
    const Appearance &given = appearances[number - 1], &got = group.appearance.value();
    EXPECT_EQ(got.color, given.color);
    EXPECT_EQ(*got.picture, *given.picture);
    EXPECT_EQ(*got.relief, *given.relief);
    EXPECT_EQ(got.normal_scale, given.normal_scale);
    EXPECT_EQ(got.gloss->metallic, given.gloss ? given.gloss->metallic : 0);
    EXPECT_EQ(got.gloss->roughness, given.gloss ? given.gloss->roughness : 0.9f);
    EXPECT_EQ(got.gloss->picture != nullptr, given.gloss.has_value());
    EXPECT_FALSE(got.v_from_bottom);
    for (std::uint32_t c = polygon.first_corner; c < polygon.first_corner + 3; ++c) {
      const Vec3& at = read.vertices[read.corners[c]];
      const double up = given.v_from_bottom ? 1 - at.y() : at.y();
      EXPECT_NEAR(read.corner_uvs[c].x(), at.x() + 4 * at.z(), 1e-5);
      EXPECT_NEAR(read.corner_uvs[c].y(), up, 1e-5);
    }
  }
  EXPECT_EQ(seen[1], 8u);
  EXPECT_EQ(seen[2], 8u);
  EXPECT_EQ(seen[0], 8u) << "the interior face included";
  const std::vector<std::byte> bytes = read_file(folder / "x.glb");
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_EQ(text.find("\x89PNG5"), text.rfind("\x89PNG5")) << "each is written once";
  EXPECT_NE(text.find("image/png"), std::string::npos);
  EXPECT_NE(text.find("image/jpeg"), std::string::npos);
}

TEST(ObjFolder, KeepsTheColorsOfAppearances) {
  std::vector<Compound> pieces = two_pieces();
  const auto convex = std::make_shared<Convex>(*pieces[0].convexes[0]);
  PolygonMesh mesh = polygon_mesh(convex->polyhedron);
  mesh.faces[1].appearance = 1;
  convex->visual = std::make_shared<const PolygonMesh>(std::move(mesh));
  pieces[0].convexes[0] = convex;
  const Folder folder;
  const std::vector<Appearance> appearances = {{Vec3f(1, 0, 0), nullptr}};
  write_obj_folder(folder / "out", make_model(pieces, stone(), 0, appearances));
  const RawMesh read = read_mesh(folder / "out/piece_0.obj");
  std::size_t red = 0;
  for (const RawMesh::Polygon& polygon : read.polygons) {
    const Vec3f color = read.groups.at(polygon.group).appearance->color;
    red += (color - Vec3f(1, 0, 0)).norm() < 0.01f;
  }
  EXPECT_EQ(red, 2u);
}

TEST(ObjFolder, HoldsEveryPieceInFullPrecision) {
  const Folder folder;
  std::vector<Compound> pieces = two_pieces();
  const ConvexPolyhedron odd =
      transformed(make_box({0, 0, 0}, {1, 1. / 3, 1. / 7}),
                  Pose{Vec3(.1, .2, .3), Quat(.9, .3, .1, .2).normalized()});
  pieces.push_back({{make_convex(odd, MaterialIndex(0u))}, {0}, {}, {}});
  write_obj_folder(folder / "out/", make_model(pieces, stone(), 0));
  EXPECT_TRUE(fs::exists(folder / "out/materials.mtl"));
  const RepairedMesh mesh = repair_mesh(read_mesh(folder / "out/piece_2.obj"), "x", {false});
  ASSERT_EQ(mesh.shells.size(), 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 1. / 21, 1e-15);
}

TEST(ObjFolder, ReplacesAnEarlierExportAndNothingElse) {
  const Folder folder;
  std::vector<Compound> pieces = two_pieces();
  write_obj_folder(folder / "out", make_model(pieces, stone(), 0));
  pieces.pop_back();
  write_obj_folder(folder / "out", make_model(pieces, stone(), 0));
  EXPECT_FALSE(fs::exists(folder / "out/piece_1.obj"));
  std::ofstream(folder / "out/thesis.txt") << "years";
  EXPECT_THROW(write_obj_folder(folder / "out", make_model(pieces, stone(), 0)), InputError);
  EXPECT_TRUE(fs::exists(folder / "out/thesis.txt"));
}

}  // namespace
}  // namespace sunder
