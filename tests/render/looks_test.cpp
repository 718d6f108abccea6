// Tests of how surfaces are drawn: appearances from mesh files, glass, metal and white stone.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/model/piece_mesh.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render::looks_test {
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

/// Returns the mean colour over the pixels of a rectangle.
Vec3f mean(const Image& image, int left, int top, int right, int bottom) {
  Vec3f sum = Vec3f::Zero();
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) sum += pixel(image, x, y);
  }
  return sum / static_cast<float>((bottom - top) * (right - left));
}

/// Returns a frame of a wall that fills the picture, x and y from -1 to 1, lit from the front.
Frame wall_frame(Stuff stuff) {
  SyntheticFrame s;
  s.add_box({-1, -1, -0.2}, {1, 1, 0}, stuff);
  s.frame.view.eye_W = {0, 0, 1.2};
  s.frame.view.target_W = {0, 0, 0};
  s.frame.view.to_sun_W = {0.2, 0.5, 1};
  s.frame.view.ground_m = -5;
  return s.frame;
}

/// Gives the surface of the frame's first mesh this appearance, and texture coordinates from 0 to 1
/// over the wall.
void apply_appearance(Frame& frame, const Appearance& appearance) {
  auto mesh = std::make_shared<Mesh>(*(*frame.meshes)[0]);
  for (Mesh::Vertex& vertex : mesh->vertices) {
    if (vertex.look == Mesh::kSurface) vertex.look = Mesh::kFirstAppearance;
    const Vec3 at = mesh->origin_T + vertex.position.cast<double>();
    mesh->uvs.emplace_back(static_cast<float>(0.5 + 0.5 * at.x()),
                           static_cast<float>(0.5 - 0.5 * at.y()));
  }
  frame.meshes = std::make_shared<const MeshStore>(MeshStore{std::move(mesh)});
  frame.appearances = std::make_shared<const std::vector<Appearance>>(std::vector{appearance});
}

EncodedImage as_png(const Image& image) {
  const std::vector<std::uint8_t> png = encode_png(image);
  const auto* begin = reinterpret_cast<const std::byte*>(png.data());
  return std::make_shared<const std::vector<std::byte>>(begin, begin + png.size());
}

/// Returns a PNG of equal rows, or columns, of these colours, `each` pixels wide.
EncodedImage stripes(const std::vector<Vec3f>& colors, bool rows, int each = 8) {
  const int count = static_cast<int>(colors.size());
  Image image{count * each, count * each, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (const float level : colors[static_cast<std::size_t>((rows ? y : x) / each)])
        image.rgb.push_back(static_cast<std::uint8_t>(level));
    }
  }
  return as_png(image);
}

/// Returns a texture of 8 x 8 pixels: red and green above, blue and white below.
Appearance four_colors(bool v_from_bottom) {
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
  return {Vec3f::Ones(), as_png(image), v_from_bottom};
}

TEST(Appearance, TexturesThatAreLeftOutOrScaledDownAreWarnedOf) {
  Renderer renderer({.width = 32, .height = 18});
  const auto warnings = [&](std::vector<Appearance> appearances) {
    Frame frame = wall_frame(Stuff::kBrick);
    frame.appearances = std::make_shared<const std::vector<Appearance>>(std::move(appearances));
    renderer.draw(frame);
    return renderer.warnings();
  };
  std::vector<Appearance> appearances;
  for (int i = 0; i < 32; ++i)
    appearances.push_back({Vec3f::Ones(), stripes({Vec3f::Constant(static_cast<float>(i))}, true)});
  EXPECT_TRUE(warnings(appearances).empty());
  appearances.push_back({Vec3f::Ones(), stripes({Vec3f::Constant(99)}, true)});
  appearances.push_back(appearances.back());  // the same picture again
  ASSERT_EQ(warnings(appearances).size(), 1u);
  EXPECT_EQ(warnings(appearances)[0].find("1 texture of meshes"), 0u) << warnings(appearances)[0];
  const Image wide{1025, 1, std::vector<std::uint8_t>(3 * 1025)};
  ASSERT_EQ(warnings({{Vec3f::Ones(), as_png(wide)}}).size(), 1u);
  EXPECT_NE(warnings({{Vec3f::Ones(), as_png(wide)}})[0].find("scaled down"), std::string::npos);
}

TEST(Appearance, TheColorOfTheFileReplacesTheMaterials) {
  Frame frame = wall_frame(Stuff::kBrick);
  apply_appearance(frame, {Vec3f(0.05f, 0.5f, 0.05f), nullptr, false});
  const Vec3f color = mean(drawn(frame), 140, 70, 180, 110);
  EXPECT_GT(color.y(), color.x() + 60);
  EXPECT_GT(color.y(), color.z() + 60);
}

TEST(Appearance, ATextureFollowsItsCoordinatesWithVFromTopOrBottom) {
  for (const bool v_from_bottom : {false, true}) {
    Frame frame = wall_frame(Stuff::kConcrete);
    apply_appearance(frame, four_colors(v_from_bottom));
    const Image image = drawn(frame);
    const int top = v_from_bottom ? 120 : 40, low = 160 - top;
    const auto at = [&](int x, int y) { return mean(image, x - 8, y - 8, x + 8, y + 8); };
    const Vec3f red = at(120, top), green = at(200, top), blue = at(120, low), white = at(200, low);
    EXPECT_GT(red.x(), 2 * red.y()) << red.transpose();
    EXPECT_GT(green.y(), 2 * green.x()) << green.transpose();
    EXPECT_GT(blue.z(), 2 * blue.x()) << blue.transpose();
    EXPECT_LT(white.maxCoeff(), 1.3f * white.minCoeff()) << white.transpose();
  }
}

const Vec3f kFlat(128, 128, 255);

/// Returns a frame of a grey wall with this normal map, lit from the right and above.
Frame normal_map_frame(const EncodedImage& relief, bool v_from_bottom = false, float scale = 1) {
  Frame frame = wall_frame(Stuff::kPlaster);
  apply_appearance(frame, {Vec3f(0.4f, 0.4f, 0.4f), nullptr, v_from_bottom, relief, scale});
  frame.view.to_sun_W = {1, 1, 1};
  return frame;
}

float brightness(const Image& image, int x, int y) {
  return mean(image, x - 6, y - 6, x + 6, y + 6).sum() / 3;
}

TEST(NormalMap, ChangesTheShadingWithVFromTopOrBottom) {
  const Vec3f left(48, 128, 228), right(208, 128, 228), up(128, 208, 228), low(128, 48, 228);
  for (const bool v_from_bottom : {false, true}) {
    const Image flat = drawn(normal_map_frame(stripes({kFlat}, false), v_from_bottom));
    const Image columns = drawn(normal_map_frame(stripes({left, right}, false), v_from_bottom));
    EXPECT_LT(brightness(columns, 120, 90), brightness(flat, 120, 90) - 15) << v_from_bottom;
    EXPECT_GT(brightness(columns, 200, 90), brightness(flat, 200, 90) + 15) << v_from_bottom;
    // The wall's texture coordinates begin at its top. With v counted from the bottom the map lies
    // upside down, and its upward normals point down.
    const Image rows = drawn(normal_map_frame(stripes({up, low}, true), v_from_bottom));
    EXPECT_GT(brightness(rows, 160, 40), brightness(flat, 160, 40) + 15) << v_from_bottom;
    EXPECT_LT(brightness(rows, 160, 140), brightness(flat, 160, 140) - 15) << v_from_bottom;
  }
}

TEST(NormalMap, FollowsTextureCoordinatesThatAreMirroredOrTurned) {
  const EncodedImage right = stripes({Vec3f(208, 128, 228)}, false);
  const auto seen = [&](const Eigen::Matrix2f& turn) {
    Frame frame = normal_map_frame(right);
    frame.view.to_sun_W = {1, 0.2, 1};
    auto mesh = std::make_shared<Mesh>(*(*frame.meshes)[0]);
    for (Eigen::Vector2f& uv : mesh->uvs) uv = Eigen::Vector2f(turn * uv);
    frame.meshes = std::make_shared<const MeshStore>(MeshStore{std::move(mesh)});
    return brightness(drawn(frame), 160, 90);
  };
  const float given = seen(Eigen::Matrix2f{{1, 0}, {0, 1}});
  EXPECT_LT(seen(Eigen::Matrix2f{{-1, 0}, {0, 1}}), given - 30) << "mirrored: right is left";
  EXPECT_NEAR(seen(Eigen::Matrix2f{{1, 0}, {0, -1}}), given, 1) << "right stays right";
  EXPECT_NEAR(seen(Eigen::Matrix2f{{30, 0}, {0, 0.1f}}), given, 1) << "however it is stretched";
  const float up = seen(Eigen::Matrix2f{{0, -1}, {1, 0}}),
              down = seen(Eigen::Matrix2f{{0, 1}, {1, 0}});
  EXPECT_GT(up, down + 5) << "turned: the sun is a little above";
  EXPECT_LT(up, given - 10);
}

TEST(NormalMap, OfScaleZeroOrConstantNormalLeavesTheFaceFlat) {
  const Image flat = drawn(normal_map_frame(stripes({kFlat}, false)));
  EXPECT_EQ(drawn(normal_map_frame(stripes({Vec3f(208, 128, 228), Vec3f(48, 128, 228)}, false),
                                   false, 0)),
            flat);
  Frame without = normal_map_frame(nullptr);
  auto mesh = std::make_shared<Mesh>(*(*without.meshes)[0]);
  mesh->uvs.clear();  // without coordinates the map is not used
  Frame nowhere = normal_map_frame(stripes({kFlat}, false));
  nowhere.meshes = std::make_shared<const MeshStore>(MeshStore{std::move(mesh)});
  EXPECT_EQ(drawn(nowhere), flat);
  const float steep =
      brightness(drawn(normal_map_frame(stripes({Vec3f(208, 128, 228)}, false))), 160, 90);
  const float steeper = brightness(
      drawn(normal_map_frame(stripes({Vec3f(168, 128, 248)}, false), false, 0.1f)), 160, 90);
  EXPECT_GT(steep, steeper + 5);
}

TEST(NormalMap, InGreyIsReadAsHeights) {
  // Heights that rise from black to white and fall again: a ridge whose left side faces left.
  std::vector<Vec3f> ridge;
  for (int i = 0; i < 64; ++i)
    ridge.push_back(Vec3f::Constant(static_cast<float>(i < 32 ? 8 * i : 8 * (63 - i))));
  const float scale = 10;
  const Image columns = drawn(normal_map_frame(stripes(ridge, false, 4), false, scale));
  const Image flat = drawn(normal_map_frame(stripes({kFlat}, false)));
  EXPECT_LT(brightness(columns, 120, 90), brightness(flat, 120, 90) - 5);
  EXPECT_GT(brightness(columns, 200, 90), brightness(flat, 200, 90) + 5);
  const Image rows = drawn(normal_map_frame(stripes(ridge, true, 4), false, scale));
  EXPECT_GT(brightness(rows, 160, 50), brightness(flat, 160, 50) + 5) << "the upper side faces up";
  EXPECT_LT(brightness(rows, 160, 130), brightness(flat, 160, 130) - 5);
}

/// Returns a frame of a ball with this appearance; the sun is behind, above and right of the eye.
Frame ball_frame(const Appearance& appearance, Stuff stuff = Stuff::kPlaster) {
  SyntheticFrame s;
  s.add_ball({0, 3, 0}, 1, stuff);
  s.frame.view.eye_W = {0, 3, 4};
  s.frame.view.target_W = {0, 3, 0};
  s.frame.view.to_sun_W = {0.5, 0.7, 1};
  apply_appearance(s.frame, appearance);
  return s.frame;
}

Appearance glossy(float roughness, float metallic, const Vec3f& color = Vec3f(0.3f, 0.05f, 0.05f)) {
  return {color, nullptr, false, nullptr, 1, MetallicRoughness{roughness, metallic}};
}

/// Returns the mean colour near the sun's reflection on the ball.
Vec3f highlight(const Image& image) { return mean(image, 176, 60, 186, 70); }

TEST(MetallicRoughness, ShowsTheSunInAHighlightThatIsNarrowerTheSmootherAndDimmerTheRougher) {
  const auto highest = [](const Image& image) {
    float most = 0;
    for (int y = 55; y < 95; ++y) {
      for (int x = 155; x < 195; ++x) most = std::max(most, pixel(image, x, y).y());
    }
    return most;
  };
  const auto wide = [&](const Image& image) {
    int count = 0;
    for (int y = 55; y < 95; ++y) {
      for (int x = 155; x < 195; ++x) count += pixel(image, x, y).y() > 0.7f * highest(image);
    }
    return count;
  };
  const Image none = drawn(ball_frame({Vec3f(0.3f, 0.05f, 0.05f), nullptr}));
  const Image smooth = drawn(ball_frame(glossy(0.2f, 0)));
  const Image medium = drawn(ball_frame(glossy(0.5f, 0)));
  const Image rough = drawn(ball_frame(glossy(1, 0)));
  EXPECT_GT(highest(smooth), highest(medium) + 30);
  EXPECT_GT(highest(medium), highest(rough) + 10);
  EXPECT_LT(highest(rough), highest(none) + 30) << "hardly more than without gloss";
  EXPECT_LT(wide(smooth), wide(medium));
  EXPECT_GT(wide(smooth), 4);
}

TEST(MetallicRoughness, OfAMetalHasItsColorAndReflectsTheSurroundings) {
  const Vec3f gold(0.8f, 0.5f, 0.1f);
  const Vec3f metal = highlight(drawn(ball_frame(glossy(0.5f, 1, gold))));
  const Vec3f lacquer = highlight(drawn(ball_frame(glossy(0.5f, 0, Vec3f(0, 0, 0)))));
  EXPECT_GT(metal.x(), 1.5f * metal.z());
  EXPECT_LT(lacquer.x(), 1.5f * lacquer.z()) << "the sun itself is warm";
  // A mirror shows the ground below and the sky above.
  const Image image = drawn(ball_frame(glossy(0.1f, 1, Vec3f(0.9f, 0.9f, 0.9f))));
  const Vec3f above = mean(image, 130, 55, 140, 60), below = mean(image, 155, 122, 165, 130);
  EXPECT_GT(above.z() / above.x(), below.z() / below.x() + 0.1f);
}

TEST(MetallicRoughness, OfTheFileReplacesTheMaterials) {
  const Appearance dull = glossy(1, 0);
  const auto off = [](const Image& a, const Image& b) {
    return (mean(a, 120, 50, 200, 130) - mean(b, 120, 50, 200, 130)).cwiseAbs().maxCoeff();
  };
  const Image steel = drawn(ball_frame(dull, Stuff::kSteel));
  EXPECT_LT(off(steel, drawn(ball_frame(dull))), 3);
  EXPECT_GT(off(steel, drawn(ball_frame(glossy(0.2f, 1), Stuff::kSteel))), 10);
}

TEST(MetallicRoughness, OfATextureIsGreenTimesRoughnessAndBlueTimesMetallic) {
  // The left half is smooth lacquer, the right half rough metal; the red channel is not used.
  Appearance appearance = glossy(1, 1, Vec3f(0.8f, 0.5f, 0.1f));
  const auto image = [&](const std::vector<Vec3f>& halves) {
    appearance.gloss->picture = stripes(halves, false, 32);
    return drawn(ball_frame(appearance));
  };
  const Vec3f lacquer(255, 51, 0), metal(0, 255, 255);
  const Image both = image({lacquer, metal});
  const auto near = [](const Image& a, const Image& b, int left, int right) {
    return (mean(a, left, 60, right, 120) - mean(b, left, 60, right, 120)).cwiseAbs().maxCoeff();
  };
  const Image all_lacquer = image({lacquer}), all_metal = image({metal});
  EXPECT_LT(near(both, all_lacquer, 125, 150), 1);
  EXPECT_LT(near(both, all_metal, 170, 195), 1);
  EXPECT_GT(near(all_lacquer, all_metal, 125, 150), 10);
  EXPECT_GT(near(all_lacquer, all_metal, 170, 195), 10);
  appearance.gloss = MetallicRoughness{0.2f, 0};
  EXPECT_LT(near(all_lacquer, drawn(ball_frame(appearance)), 125, 195), 1) << "51 of 255 is 0.2";
}

TEST(Appearance, BrokenFacesAreDrawnInTheirMaterial) {
  Frame plain = wall_frame(Stuff::kConcrete);
  auto mesh = std::make_shared<Mesh>(*(*plain.meshes)[0]);
  for (Mesh::Vertex& vertex : mesh->vertices) vertex.look = Mesh::kInterior;
  plain.meshes = std::make_shared<const MeshStore>(MeshStore{mesh});
  const Image broken = drawn(plain);
  Frame painted = plain;
  apply_appearance(painted, four_colors(false));  // the mesh has no surface vertices
  EXPECT_EQ(drawn(painted), broken);
}

TEST(Appearance, EachFrameIsDrawnWithItsOwn) {
  Frame red = wall_frame(Stuff::kConcrete), blue = red;
  apply_appearance(red, {Vec3f(0.6f, 0, 0), nullptr, false});
  apply_appearance(blue, {Vec3f(0, 0, 0.6f), nullptr, false});
  const Frame plain = wall_frame(Stuff::kConcrete);
  const Image before = drawn(plain);
  const Vec3f seen_red = mean(drawn(red), 140, 70, 180, 110);
  const Vec3f seen_blue = mean(drawn(blue), 140, 70, 180, 110);
  EXPECT_GT(seen_red.x(), 2 * seen_red.z());
  EXPECT_GT(seen_blue.z(), 2 * seen_blue.x());
  EXPECT_EQ(drawn(plain), before);
}

TEST(Appearance, WithAnUnreadableTextureIsRefused) {
  Frame frame = wall_frame(Stuff::kConcrete);
  Appearance appearance;
  appearance.picture = std::make_shared<const std::vector<std::byte>>(20);
  apply_appearance(frame, appearance);
  EXPECT_THROW(drawn(frame), InputError);
  EXPECT_NO_THROW(drawn(wall_frame(Stuff::kConcrete)))
      << "the renderer can be used after the error";
}

/// Returns a frame of a pane in front of a wall, with a crack in the middle of the pane.
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

TEST(Glass, AbsorbsRedFromWhatIsBehindIt) {
  const Vec3 eye(0.3, 1.1, 4);
  const Vec3f with = mean(drawn(pane_frame(eye)), 130, 60, 150, 110);
  const Vec3f without = mean(drawn(pane_frame(eye, false)), 130, 60, 150, 110);
  EXPECT_LT(with.x(), without.x() - 8) << "red is taken";
  EXPECT_LT(with.x() / with.y(), without.x() / without.y());
}

TEST(Glass, IsNeitherBlackNorOverexposedFromAnyDirection) {
  for (int step = 0; step < 12; ++step) {
    const double angle = 0.13 + 0.5 * step;
    const Image image =
        drawn(pane_frame(Vec3(3 * std::sin(angle), 0.3 + 0.2 * step, 3 * std::cos(angle))));
    std::size_t black = 0, white = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      black += image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2] == 0;  // NaN is black
      white += image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2] == 3 * 255;
    }
    EXPECT_EQ(black, 0u) << step;
    EXPECT_LT(white, 40u) << step;
  }
}

TEST(Metal, ReflectsTheSkyAboveAndTheGroundBelow) {
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

TEST(WhiteStone, InTheSunKeepsItsShading) {
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
}  // namespace sunder::render::looks_test
