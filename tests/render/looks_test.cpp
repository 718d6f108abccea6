// What pictures show of what things are made of: a file's paints, glass, metal, white stone.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/model/piece_mesh.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

constexpr int kWidth = 320, kHeight = 180;

Image drawn(const Frame& frame) {
  static Renderer renderer({.width = kWidth, .height = kHeight});
  return renderer.draw(frame);
}

Vec3f pixel(const Image& image, int x, int y) {
  const auto i = 3 * static_cast<std::size_t>(y * image.width + x);
  return Vec3f(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
}

/// The mean over pixels of a rectangle.
Vec3f mean(const Image& image, int left, int top, int right, int bottom) {
  Vec3f sum = Vec3f::Zero();
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) sum += pixel(image, x, y);
  }
  return sum / static_cast<float>((bottom - top) * (right - left));
}

/// A wall that fills the picture, x and y from -1 to 1, seen and lit from the front.
Frame wall_frame(Stuff stuff) {
  SyntheticFrame s;
  s.add_box({-1, -1, -0.2}, {1, 1, 0}, stuff);
  s.frame.view.eye_W = {0, 0, 1.2};
  s.frame.view.target_W = {0, 0, 0};
  s.frame.view.to_sun_W = {0.2, 0.5, 1};
  s.frame.view.ground_m = -5;
  return s.frame;
}

/// The frame with every vertex of its first mesh of the paint, and texture coordinates that go from
/// 0 to 1 over the wall.
void paint_all(Frame& frame, const Paint& paint) {
  auto mesh = std::make_shared<Mesh>(*(*frame.meshes)[0]);
  for (Mesh::Vertex& vertex : mesh->vertices) {
    if (vertex.look == Mesh::kSurface) vertex.look = Mesh::kFirstPaint;
    const Vec3 at = mesh->origin_T + vertex.position.cast<double>();
    mesh->uvs.emplace_back(static_cast<float>(0.5 + 0.5 * at.x()),
                           static_cast<float>(0.5 - 0.5 * at.y()));
  }
  frame.meshes = std::make_shared<const MeshStore>(MeshStore{std::move(mesh)});
  frame.paints = std::make_shared<const std::vector<Paint>>(std::vector{paint});
}

/// Red and green above, blue and white below, 8 x 8.
Paint four_colors(bool from_below) {
  Image image{8, 8, {}};
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool low = y >= 4, right = x >= 4;
      const std::uint8_t rgb[3] = {static_cast<std::uint8_t>(low == right ? 255 : 0),
                                   static_cast<std::uint8_t>(right ? 255 : 0),
                                   static_cast<std::uint8_t>(low ? 255 : 0)};
      image.rgb.insert(image.rgb.end(), rgb, rgb + 3);
    }
  }
  const std::vector<std::uint8_t> png = encode_png(image);
  const auto* begin = reinterpret_cast<const std::byte*>(png.data());
  return {Vec3f::Ones(), std::make_shared<const std::vector<std::byte>>(begin, begin + png.size()),
          from_below};
}

TEST(Paint, AFilesColorIsSeenInPlaceOfTheMaterials) {
  Frame frame = wall_frame(Stuff::kBrick);
  paint_all(frame, {Vec3f(0.05f, 0.5f, 0.05f), nullptr, false});
  const Vec3f color = mean(drawn(frame), 140, 70, 180, 110);
  EXPECT_GT(color.y(), color.x() + 60);
  EXPECT_GT(color.y(), color.z() + 60);
}

TEST(Paint, APictureLiesWhereItsCoordinatesSayEitherWayUp) {
  for (const bool from_below : {false, true}) {
    Frame frame = wall_frame(Stuff::kConcrete);
    paint_all(frame, four_colors(from_below));
    const Image image = drawn(frame);
    const int top = from_below ? 120 : 40, low = 160 - top;
    const auto at = [&](int x, int y) { return mean(image, x - 8, y - 8, x + 8, y + 8); };
    const Vec3f red = at(120, top), green = at(200, top), blue = at(120, low), white = at(200, low);
    EXPECT_GT(red.x(), 2 * red.y()) << red.transpose();
    EXPECT_GT(green.y(), 2 * green.x()) << green.transpose();
    EXPECT_GT(blue.z(), 2 * blue.x()) << blue.transpose();
    EXPECT_LT(white.maxCoeff(), 1.3f * white.minCoeff()) << white.transpose();
  }
}

TEST(Paint, WhatBrokeLooksAsItsMaterialDoes) {
  Frame plain = wall_frame(Stuff::kConcrete);
  auto mesh = std::make_shared<Mesh>(*(*plain.meshes)[0]);
  for (Mesh::Vertex& vertex : mesh->vertices) vertex.look = Mesh::kInterior;
  plain.meshes = std::make_shared<const MeshStore>(MeshStore{mesh});
  const Image broken = drawn(plain);
  Frame painted = plain;
  paint_all(painted, four_colors(false));  // its surface, of which it has none
  EXPECT_EQ(drawn(painted), broken);
}

TEST(Paint, TheNextFramesPaintsAreThoseSeen) {
  Frame red = wall_frame(Stuff::kConcrete), blue = red;
  paint_all(red, {Vec3f(0.6f, 0, 0), nullptr, false});
  paint_all(blue, {Vec3f(0, 0, 0.6f), nullptr, false});
  const Frame plain = wall_frame(Stuff::kConcrete);
  const Image before = drawn(plain);
  const Vec3f seen_red = mean(drawn(red), 140, 70, 180, 110);
  const Vec3f seen_blue = mean(drawn(blue), 140, 70, 180, 110);
  EXPECT_GT(seen_red.x(), 2 * seen_red.z());
  EXPECT_GT(seen_blue.z(), 2 * seen_blue.x());
  EXPECT_EQ(drawn(plain), before);
}

TEST(Paint, APictureThatIsNoneIsRefused) {
  Frame frame = wall_frame(Stuff::kConcrete);
  Paint paint;
  paint.picture = std::make_shared<const std::vector<std::byte>>(20);
  paint_all(frame, paint);
  EXPECT_THROW(drawn(frame), InputError);
  EXPECT_NO_THROW(drawn(wall_frame(Stuff::kConcrete))) << "and the renderer goes on";
}

/// A pane before a wall, its broken edge in the middle.
Frame pane_frame(const Vec3& eye, bool with_pane = true) {
  SyntheticFrame s;
  s.add_box({-4, 0, -2}, {4, 3, -1.9}, Stuff::kWood);
  if (with_pane) {
    s.add_box({-1, 0.2, 0}, {0, 2, 0.02}, Stuff::kGlass);
    s.add_box({0.01, 0.2, 0}, {1, 2, 0.02}, Stuff::kGlass);
  }
  s.frame.view.eye_W = eye;
  s.frame.view.target_W = {0, 1.1, 0};
  s.frame.view.to_sun_W = {0.5, 0.7, 0.6};
  return s.frame;
}

TEST(Glass, TakesColorFromWhatIsBehindItAndIsBrighterWhereItIsLookedAlong) {
  const Vec3 eye(0.3, 1.1, 4);
  const Vec3f with = mean(drawn(pane_frame(eye)), 130, 60, 150, 110);
  const Vec3f without = mean(drawn(pane_frame(eye, false)), 130, 60, 150, 110);
  EXPECT_LT(with.x(), without.x() - 8) << "red is taken";
  EXPECT_LT(with.x() / with.y(), without.x() / without.y());
}

TEST(Glass, FromAnywhereIsNeitherBlackNorBurntOut) {
  for (int step = 0; step < 12; ++step) {
    const double angle = 0.13 + 0.5 * step;
    const Image image =
        drawn(pane_frame(Vec3(3 * std::sin(angle), 0.3 + 0.2 * step, 3 * std::cos(angle))));
    std::size_t black = 0, white = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      black += image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2] == 0;  // what is no number is
      white += image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2] == 3 * 255;
    }
    EXPECT_EQ(black, 0u) << step;
    EXPECT_LT(white, 40u) << step;
  }
}

TEST(Metal, MirrorsTheSkyAboveAndTheGroundBelow) {
  SyntheticFrame s;
  s.add_ball({0, 3, 0}, 1, Stuff::kSteel);
  s.frame.view.eye_W = {0, 3, 4};
  s.frame.view.target_W = {0, 3, 0};
  s.frame.view.to_sun_W = {0.9, 0.5, -0.5};
  s.frame.view.ground_color = {0.5f, 0.3f, 0.1f};
  const Image image = drawn(s.frame);
  const Vec3f above = mean(image, 155, 50, 165, 60), below = mean(image, 155, 120, 165, 130);
  EXPECT_GT(above.z() / above.x(), 1.05f) << above.transpose();
  EXPECT_GT(below.x() / below.z(), 1.2f) << below.transpose();
}

TEST(WhiteStone, InTheSunKeepsItsShape) {
  SyntheticFrame s;
  s.add_ball({0, 1, 0}, 1, Stuff::kPlaster);
  auto materials = std::make_shared<std::vector<Material>>(*s.frame.materials);
  (*materials)[static_cast<std::size_t>(Stuff::kPlaster)].surface = {Texture::kPlain,
                                                                     Vec3f(0.7f, 0.68f, 0.64f)};
  s.frame.materials = materials;
  s.frame.view.eye_W = {0, 1, 4};
  s.frame.view.target_W = {0, 1, 0};
  s.frame.view.to_sun_W = {1, 0.3, 1};
  const Image image = drawn(s.frame);
  const float lit = mean(image, 180, 75, 190, 85).x(), slanting = mean(image, 139, 75, 149, 85).x();
  EXPECT_LT(lit, 240);
  EXPECT_GT(lit, slanting + 18) << "it is round";
}

}  // namespace
}  // namespace sunder::render
