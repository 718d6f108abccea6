// Tests that frame files and recordings keep the appearances (colours, textures) of mesh files.
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/frame_file.h"
#include "engine/io/frame_parts.h"
#include "engine/io/recording/recording.h"
#include "engine/model/piece_mesh.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

class AppearanceIo : public ::testing::Test {
 protected:
  ~AppearanceIo() override { fs::remove(path_); }

  const fs::path path_ = fs::temp_directory_path() / ("sunder-paint-" + std::to_string(::getpid()));
};

std::shared_ptr<const std::vector<std::byte>> picture(std::uint8_t first) {
  return std::make_shared<const std::vector<std::byte>>(
      std::vector{std::byte{first}, std::byte{2}, std::byte{0}});
}

/// Returns a frame of a ball without an appearance, and of a ball with texture coordinates of which
/// one vertex has the first and one the fourth appearance.
std::shared_ptr<Frame> textured_frame() {
  auto frame = std::make_shared<Frame>();
  frame->materials = std::make_shared<const std::vector<Material>>(1);
  const auto shared = picture(7);
  frame->appearances = std::make_shared<const std::vector<Appearance>>(std::vector<Appearance>{
      {Vec3f(1, 0.5f, 0.25f), shared, true},
      {Vec3f(0, 0, 1), nullptr, false},
      {Vec3f(1, 1, 1), picture(9), false},
      {Vec3f(0.5f, 1, 1), shared, true, picture(5), 0.5f},
      {Vec3f(0.5f, 1, 1), nullptr, true, shared, -2, MetallicRoughness{0.25f, 1, picture(3)}},
      {Vec3f(0.5f, 1, 1), nullptr, true, nullptr, 1, MetallicRoughness{0.5f, 0}}});
  auto mesh = std::make_shared<Mesh>(*make_ball_mesh(1, MaterialIndex(0)));
  mesh->vertices[3].look = Mesh::kFirstAppearance;
  mesh->vertices[5].look = Mesh::kFirstAppearance + 3;
  for (std::size_t v = 0; v < mesh->vertices.size(); ++v) {
    mesh->uvs.emplace_back(static_cast<float>(v), -0.5f);
  }
  frame->meshes = std::make_shared<const MeshStore>(
      MeshStore{make_ball_mesh(2, MaterialIndex(0)), std::move(mesh)});
  frame->bodies.resize(1);
  frame->instances = {{MeshIndex(0), 0}, {MeshIndex(1), 0}};
  return frame;
}

void expect_same(const Frame& read, const Frame& frame) {
  ASSERT_TRUE(read.appearances);
  ASSERT_EQ(read.appearances->size(), frame.appearances->size());
  for (std::size_t p = 0; p < frame.appearances->size(); ++p) {
    const Appearance &got = (*read.appearances)[p], &given = (*frame.appearances)[p];
    EXPECT_EQ(got.color, given.color);
    EXPECT_EQ(got.v_from_bottom, given.v_from_bottom);
    ASSERT_EQ(got.picture == nullptr, given.picture == nullptr);
    if (given.picture) {
      EXPECT_EQ(*got.picture, *given.picture);
    }
    ASSERT_EQ(got.relief == nullptr, given.relief == nullptr);
    if (given.relief) {
      EXPECT_EQ(*got.relief, *given.relief);
    }
    EXPECT_EQ(got.normal_scale, given.normal_scale);
    ASSERT_EQ(got.gloss.has_value(), given.gloss.has_value());
    if (!given.gloss) continue;
    EXPECT_EQ(got.gloss->roughness, given.gloss->roughness);
    EXPECT_EQ(got.gloss->metallic, given.gloss->metallic);
    ASSERT_EQ(got.gloss->picture == nullptr, given.gloss->picture == nullptr);
    if (given.gloss->picture) {
      EXPECT_EQ(*got.gloss->picture, *given.gloss->picture);
    }
  }
  EXPECT_EQ((*read.appearances)[0].picture, (*read.appearances)[3].picture)
      << "a shared texture is read once";
  EXPECT_EQ((*read.appearances)[0].picture, (*read.appearances)[4].relief);
  ASSERT_EQ(read.meshes->size(), 2u);
  EXPECT_TRUE((*read.meshes)[0]->uvs.empty());
  const Mesh &got = *(*read.meshes)[1], &given = *(*frame.meshes)[1];
  EXPECT_EQ(got.uvs, given.uvs);
  for (std::size_t v = 0; v < given.vertices.size(); ++v)
    EXPECT_EQ(got.vertices[v].look, given.vertices[v].look);
}

TEST_F(AppearanceIo, FrameFilesKeepAppearancesTexturesAndTextureCoordinates) {
  const auto frame = textured_frame();
  write_frame(path_, *frame);
  expect_same(*read_frame(path_), *frame);
}

TEST_F(AppearanceIo, RecordingsKeepAppearancesTexturesAndTextureCoordinates) {
  const auto frame = textured_frame();
  {
    RecordingWriter writer(path_);
    writer.take(frame);
    writer.finish();
  }
  RecordingReader reader(path_);
  const FramePtr read = reader.next();
  ASSERT_TRUE(read);
  expect_same(*read, *frame);
}

TEST_F(AppearanceIo, AnAppearanceWithoutNormalMapAndRoughnessHasTheBytesOfEarlierVersions) {
  ByteWriter out;
  put(out, std::vector<Appearance>{{Vec3f(1, 0.5f, 0.25f), picture(7), true},
                                   {Vec3f(0, 0, 1), nullptr}});
  EXPECT_EQ(out.bytes.size(), 4 + (12 + 1 + 4 + 4 + 3) + (12 + 1 + 4u));
}

TEST_F(AppearanceIo, AVertexOfAMissingAppearanceIsRefused) {
  const auto frame = textured_frame();
  frame->appearances = std::make_shared<const std::vector<Appearance>>(1);
  write_frame(path_, *frame);
  EXPECT_THROW(read_frame(path_), InputError);
}

}  // namespace
}  // namespace sunder
