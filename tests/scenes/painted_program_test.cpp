// Tests that the appearances of a mesh file are in the files and pictures that the program writes.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/io/bytes.h"
#include "engine/io/figures.h"
#include "engine/io/mesh/mesh_reader.h"
#include "render/image/image.h"
#include "scenes/file/text_file.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

/// Writes a box as OBJ with one appearance. Texture coordinates are ((x + z) / 2, y / 2).
void write_textured_box(const Folder& folder) {
  std::string text = "mtllib box.mtl\nusemtl painted\n";
  const ConvexPolyhedron box = make_box(Vec3(0, 0, 0), Vec3(1, 2, 1));
  for (const Vec3& v : box.vertices) {
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\nvt " + std::to_string(0.5 * (v.x() + v.z())) + " " +
            std::to_string(0.5 * v.y()) + "\n";
  }
  for (std::size_t f = 0; f < box.faces.size(); ++f) {
    text += "f";
    for (const std::uint32_t v : box.face_corners(f)) {
      text += " " + std::to_string(v + 1) + "/" + std::to_string(v + 1);
    }
    text += "\n";
  }
  std::ofstream(folder / "box.obj") << text;
  std::ofstream(folder / "box.mtl")
      << "newmtl painted\nmap_Kd color.png\nmap_Bump -bm 2 heights.png\nPr 0.5\n";
  render::Image color{4, 4, {}}, heights{4, 4, {}};
  for (std::uint8_t i = 0; i < 16; ++i) {
    color.rgb.insert(color.rgb.end(), {static_cast<std::uint8_t>(16 * i), 200, 10});
    heights.rgb.insert(heights.rgb.end(), 3, i % 4 < 2 ? 0 : 255);
  }
  render::write_png(folder / "color.png", color);
  render::write_png(folder / "heights.png", heights);
}

TEST(Fracture, OfATexturedFileGivesTexturedPieces) {
  const Folder folder;
  write_textured_box(folder);
  const std::string command = "fracture " + folder / "box.obj" + " --pattern grid:2 -o ";
  ASSERT_EQ(sunder(command + folder / "x.glb").exit_code, 0);
  const RawMesh pieces = read_mesh(folder / "x.glb");
  std::size_t textured = 0, inside = 0;
  for (const RawMesh::Polygon& polygon : pieces.polygons) {
    const Appearance appearance = pieces.groups.at(polygon.group).appearance.value();
    inside += !appearance.picture;
    if (!appearance.picture) continue;
    ++textured;
    EXPECT_EQ(*appearance.picture, read_file(folder / "color.png"));
    EXPECT_EQ(appearance.gloss->roughness, 0.5f);
    EXPECT_EQ(appearance.normal_scale, 2);
    const render::Image normals = render::decode_picture(*appearance.relief);
    EXPECT_EQ(normals.width, 4);
    EXPECT_GT(normals.rgb[2], normals.rgb[0] + 20) << "heights are exported as normals";
    for (std::uint32_t c = polygon.first_corner; c < polygon.first_corner + 3; ++c) {
      const Vec3& at = pieces.vertices[pieces.corners[c]];
      EXPECT_NEAR(pieces.corner_uvs[c].x(), 0.5 * (at.x() + at.z()), 1e-5);
      EXPECT_NEAR(pieces.corner_uvs[c].y(), 1 - 0.5 * at.y(), 1e-5) << "v counts from above";
    }
  }
  EXPECT_GE(textured, 48u) << "eight pieces with three sides each";
  EXPECT_GE(inside, 48u);
  ASSERT_EQ(sunder(command + folder / "a.png").exit_code, 0);
  std::filesystem::remove(folder / "box.mtl");
  ASSERT_EQ(sunder(command + folder / "b.png").exit_code, 0);
  EXPECT_NE(scenes::read_text(folder / "a.png"), scenes::read_text(folder / "b.png"));
}

/// Returns the warnings of a JSON document, one per line.
std::string warnings_in(const std::string& json) {
  std::string all;
  for (const auto& [place, value] : parse_figures(json, "json")) {
    if (place.starts_with("/warnings/")) all += std::get<std::string>(value) + "\n";
  }
  return all;
}

TEST(Textures, ThatAreMissingAreNamedInTextAndInJson) {
  const Folder folder;
  write_textured_box(folder);
  std::ofstream(folder / "s.toml") << "[scene]\ndescription = \"x\"\nduration_s = 0.1\n"
                                      "[[body]]\nmesh = \"box.obj\"\n"
                                      "[[body]]\nmesh = \"box.obj\"\nposition = [9, 0, 0]\n";
  const std::string mesh = folder / "box.obj", scene = folder / "s.toml";
  const std::string commands[] = {"fracture " + mesh + " --pattern grid:2 --quiet --json -",
                                  "vacd " + mesh + " --quiet --json -",
                                  "simulate " + scene + " --quiet --json -"};
  for (const std::string& command : commands) {
    const Outcome outcome = sunder(command);
    EXPECT_EQ(outcome.err, "") << command;
    EXPECT_EQ(warnings_in(outcome.out), "") << command;
  }
  std::filesystem::remove(folder / "color.png");
  std::filesystem::remove(folder / "heights.png");
  for (const std::string& command : commands) {
    const Outcome outcome = sunder(command);
    EXPECT_EQ(outcome.exit_code, 0) << command;
    const std::string said = warnings_in(outcome.out);
    EXPECT_NE(said.find("'color.png', 'heights.png'"), std::string::npos) << command << said;
    EXPECT_NE(outcome.err.find("'color.png', 'heights.png'"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << "one warning for all bodies";
  }
  EXPECT_EQ(sunder("simulate " + scene + " --quiet --set body.0.look=material " +
                   "--set body.1.look=material")
                .err,
            "")
      << "no body uses them";
  std::filesystem::remove(folder / "box.mtl");
  EXPECT_NE(sunder(commands[0]).err.find("'box.mtl'"), std::string::npos);
  std::ofstream(folder / "t.gltf")
      << R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":48,"uri":"t.bin"}],)"
      << R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteLength":48}],)"
      << R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],)"
      << R"("images":[{"uri":"wood%20a.png"}],"textures":[{"source":0}],"materials":)"
      << R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"meshes":[{"primitives":)"
      << R"([{"mode":5,"material":0,"attributes":{"POSITION":0}}]}]})";
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::ofstream(folder / "t.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(corners), sizeof corners);
  EXPECT_NE(sunder("vacd " + folder / "t.gltf").err.find("wood%20a.png"), std::string::npos);
}

}  // namespace
}  // namespace sunder::tests
