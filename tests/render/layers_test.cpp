// Tests of layers (depth, normals and ids of each pixel) and of transparent pictures.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "render/renderer.h"
#include "tests/render/synthetic_frame.h"
#include "tests/render/test_folder.h"

namespace sunder::render::layers_test {
namespace {

constexpr int kWidth = 160, kHeight = 90;

/// Returns a frame of a wall 2 m wide, 9 m in front of the eye and facing it.
Frame wall() {
  SyntheticFrame s;
  s.add_box({-1, 0, -1}, {1, 4, 1}, Stuff::kConcrete);
  s.frame.bodies[0].key = 70000;
  s.frame.view.eye_W = Vec3(0, 2, 10);
  s.frame.view.target_W = Vec3(0, 2, 0);
  s.frame.view.fov_rad = 0.6;
  return s.frame;
}

RenderOptions with_layers(std::vector<std::string> names) {
  RenderOptions options{.width = kWidth, .height = kHeight};
  options.layers = std::move(names);
  return options;
}

std::vector<std::uint16_t> at(const Image16& image, int x, int y) {
  const auto first = static_cast<std::size_t>((y * image.width + x) * image.channels);
  const auto from = image.values.begin() + static_cast<std::ptrdiff_t>(first);
  return {from, from + image.channels};
}

TEST(Layers, HaveDepthNormalAndIdOfEveryPixel) {
  Renderer renderer(with_layers({"depth", "normals", "ids"}));
  renderer.draw(wall());
  const std::vector<Layer>& layers = renderer.layers();
  ASSERT_EQ(layers.size(), 3u);
  const Image16 &depth = layers[0].image, &normals = layers[1].image, &ids = layers[2].image;
  double far_m = 0;
  for (const auto& [key, word] : depth.words)
    if (key == "far_m") far_m = std::stod(word);
  EXPECT_EQ(far_m, 64) << "at least four times the distance of the target";
  const int x = kWidth / 2, y = kHeight / 2;
  EXPECT_NEAR(at(depth, x, y)[0] / 65535.0 * far_m, 9, 0.01);
  EXPECT_EQ(at(depth, 2, 2)[0], 65535) << "the sky";
  const std::vector<std::uint16_t> n = at(normals, x, y), up = at(normals, 2, kHeight - 2);
  EXPECT_NEAR(n[0], 32767.5, 1);
  EXPECT_NEAR(n[1], 32767.5, 1);
  EXPECT_EQ(n[2], 65535) << "towards the eye";
  EXPECT_EQ(up[1], 65535) << "the ground";
  EXPECT_EQ(at(normals, 2, 2), (std::vector<std::uint16_t>{0, 0, 0})) << "the sky";
  EXPECT_EQ(at(ids, x, y), (std::vector<std::uint16_t>{70001 - 65536, 1, 0}));
  EXPECT_EQ(at(ids, 2, kHeight - 2), (std::vector<std::uint16_t>{0, 0, 0})) << "the ground";
}

TEST(Layers, OfDepthKeepTheirScaleWhenTheCameraMoves) {
  Renderer renderer(with_layers({"depth"}));
  Frame frame = wall();
  renderer.draw(frame);
  const Image16 first = renderer.layers()[0].image;
  frame.view.eye_W.z() = 30;
  renderer.draw(frame);
  const Image16& second = renderer.layers()[0].image;
  EXPECT_EQ(second.words, first.words);
  EXPECT_NEAR(at(second, kWidth / 2, kHeight / 2)[0] / 65535.0 * 64, 29, 0.01);
}

TEST(Layers, OfDepthInMetresAreFloatsThatOtherProgramsRead) {
  const TestFolder folder;
  Renderer renderer(with_layers({"depth_m"}));
  const auto sink = make_picture_sink(folder / "wall.png", renderer);
  sink->take(std::make_shared<Frame>(wall()));
  sink->finish();
  const std::vector<float>& metres = renderer.layers()[0].metres;
  const auto middle = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
  ASSERT_EQ(metres.size(), static_cast<std::size_t>(kWidth * kHeight));
  EXPECT_NEAR(metres[middle], 9, 1e-4);
  EXPECT_TRUE(std::isinf(metres[0])) << "the sky";
  const std::vector<std::byte> bytes = read_file(folder / "wall_depth_m.exr");
  const std::size_t row = kWidth * sizeof(float), rows = kHeight * (8 + row);
  ASSERT_GT(bytes.size(), rows);
  float stored = 0;
  std::memcpy(&stored, &bytes[bytes.size() - rows + kHeight / 2 * (8 + row) + 8 + row / 2], 4);
  EXPECT_EQ(stored, metres[middle]);
  std::uint64_t offset = 0;  // of the last row, from the table
  std::memcpy(&offset, &bytes[bytes.size() - rows - 8], 8);
  EXPECT_EQ(offset, bytes.size() - 8 - row);
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) return;
  const std::string raw = (folder / "raw").string();
  ASSERT_EQ(std::system(("ffmpeg -v error -i " + (folder / "wall_depth_m.exr").string() +
                         " -f rawvideo -pix_fmt grayf32le " + raw)
                            .c_str()),
            0);
  const std::vector<std::byte> decoded = read_file(raw);
  ASSERT_EQ(decoded.size(), metres.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(decoded.data(), metres.data(), decoded.size()), 0);
}

TEST(Layers, IncludeTexturedSurfaces) {
  Frame frame = wall();
  auto mesh = std::make_shared<Mesh>(*(*frame.meshes)[0]);
  for (Mesh::Vertex& vertex : mesh->vertices) vertex.look = Mesh::kFirstAppearance;
  frame.meshes = std::make_shared<const MeshStore>(MeshStore{std::move(mesh)});
  frame.appearances = std::make_shared<const std::vector<Appearance>>(1);
  Renderer renderer(with_layers({"ids"}));
  renderer.draw(frame);
  EXPECT_EQ(at(renderer.layers().front().image, kWidth / 2, kHeight / 2),
            (std::vector<std::uint16_t>{70001 - 65536, 1, 0}));
}

TEST(Layers, DoNotChangeThePictureAndDoNotDependOnItsSamples) {
  const Frame frame = wall();
  Renderer plain(with_layers({})), layered(with_layers({"ids", "depth"}));
  EXPECT_TRUE(plain.layers().empty());
  const Image image = plain.draw(frame);
  EXPECT_EQ(layered.draw(frame), image);
  EXPECT_EQ(layered.draw(frame), image) << "after layers have been drawn";
  RenderOptions many = with_layers({"depth"});
  many.samples = 4;
  Renderer sampled(many);
  const Image mean = sampled.draw(frame);
  many.layers.clear();
  EXPECT_EQ(Renderer(many).draw(frame), mean);
  EXPECT_EQ(sampled.layers()[0].image.values, layered.layers()[1].image.values);
}

TEST(Layers, AnUnknownLayerIsRefusedWithTheAllowedOnes) {
  try {
    Renderer renderer(with_layers({"depth", "smell"}));
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("smell"), std::string::npos) << said;
    EXPECT_NE(said.find("normals"), std::string::npos) << said;
  }
}

TEST(Transparent, PicturesHaveAlphaOnlyWhereThereAreObjects) {
  RenderOptions options{.width = kWidth, .height = kHeight};
  options.transparent = true;
  options.samples = 4;
  Renderer renderer(options);
  Frame frame = wall();
  const Image image = renderer.draw(frame);
  ASSERT_EQ(image.alpha.size(), static_cast<std::size_t>(kWidth * kHeight));
  const auto alpha = [&](const Image& of, int x, int y) {
    return of.alpha[static_cast<std::size_t>(y * kWidth + x)];
  };
  EXPECT_EQ(alpha(image, kWidth / 2, kHeight / 2), 255);
  EXPECT_EQ(alpha(image, 2, 2), 0) << "no sky";
  EXPECT_EQ(alpha(image, 2, kHeight - 2), 0) << "no ground";
  frame.dust = {{Vec3f(2.2f, 2, 2), Quatf::Identity(), 0.5f, 0.8f, MaterialIndex(0)}};
  const Image dusty = renderer.draw(frame);
  int thin = 0;
  for (const std::uint8_t covered : dusty.alpha) thin += covered > 20 && covered < 235 ? 1 : 0;
  EXPECT_GT(thin, 30) << "dust covers a part";
  SyntheticFrame pane;
  pane.add_box({-1, 0, -0.01}, {1, 4, 0.01}, Stuff::kGlass);
  Frame glass = frame;
  glass.dust.clear();
  glass.bodies = pane.frame.bodies;
  glass.instances = pane.frame.instances;
  glass.meshes = pane.frame.meshes;
  const std::uint8_t through = alpha(renderer.draw(glass), kWidth / 2, kHeight / 2);
  EXPECT_GT(through, 5);
  EXPECT_LT(through, 200) << "glass covers a part";
}

TEST(PictureSink, WritesLayersBesideThePictureAndRefusesThemForAVideo) {
  const TestFolder folder;
  RenderOptions options = with_layers({"depth"});
  options.transparent = true;
  Renderer renderer(options);
  const auto sink = make_picture_sink(folder / "wall.png", renderer);
  sink->take(std::make_shared<Frame>(wall()));
  sink->finish();
  const Image picture = read_png(folder / "wall.png");
  const Image depth = read_png(folder / "wall_depth.png");  // higher bytes of the 16-bit depths
  EXPECT_EQ(picture.width, kWidth);
  ASSERT_EQ(depth.height, kHeight);
  EXPECT_EQ(depth.rgb[0], 255);
  const auto middle = static_cast<std::size_t>(3 * (kHeight / 2 * kWidth + kWidth / 2));
  EXPECT_NEAR(depth.rgb[middle], 255 * 9 / 64.0, 1);
  try {
    make_picture_sink(folder / "wall.mp4", renderer);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("images"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sunder::render::layers_test
