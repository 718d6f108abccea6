// What a file paints is in what the program makes of it.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/io/bytes.h"
#include "engine/io/mesh/mesh_reader.h"
#include "render/image/image.h"
#include "scenes/file/text_file.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

/// A box of one paint as OBJ, whose pictures are half as large along as it is: the coordinates of a
/// place are (x + z, y) / 2.
void write_painted_box(const Folder& folder) {
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

TEST(Fracture, OfAPaintedFileGivesPaintedPieces) {
  const Folder folder;
  write_painted_box(folder);
  const std::string command = "fracture " + folder / "box.obj" + " --pattern grid:2 -o ";
  ASSERT_EQ(sunder(command + folder / "x.glb").exit_code, 0);
  const RawMesh pieces = read_mesh(folder / "x.glb");
  std::size_t painted = 0, inside = 0;
  for (const RawMesh::Polygon& polygon : pieces.polygons) {
    const Paint paint = pieces.groups.at(polygon.group).paint.value();
    inside += !paint.picture;
    if (!paint.picture) continue;
    ++painted;
    EXPECT_EQ(*paint.picture, read_file(folder / "color.png"));
    EXPECT_EQ(paint.gloss->roughness, 0.5f);
    EXPECT_EQ(paint.relief_scale, 2);
    const render::Image normals = render::decode_picture(*paint.relief);
    EXPECT_EQ(normals.width, 4);
    EXPECT_GT(normals.rgb[2], normals.rgb[0] + 20) << "other programs want normals, not heights";
    for (std::uint32_t c = polygon.first_corner; c < polygon.first_corner + 3; ++c) {
      const Vec3& at = pieces.vertices[pieces.corners[c]];
      EXPECT_NEAR(pieces.corner_uvs[c].x(), 0.5 * (at.x() + at.z()), 1e-5);
      EXPECT_NEAR(pieces.corner_uvs[c].y(), 1 - 0.5 * at.y(), 1e-5) << "from above";
    }
  }
  EXPECT_GE(painted, 48u) << "eight pieces with three sides each";
  EXPECT_GE(inside, 48u);
  ASSERT_EQ(sunder(command + folder / "a.png").exit_code, 0);
  std::filesystem::remove(folder / "box.mtl");
  ASSERT_EQ(sunder(command + folder / "b.png").exit_code, 0);
  EXPECT_NE(scenes::read_text(folder / "a.png"), scenes::read_text(folder / "b.png"));
}

}  // namespace
}  // namespace sunder::tests
