// Tests of the tracks of bodies: births, ends, parents and the meshes of a body in time.
#include "engine/io/scene_export/body_tracks.h"

#include <map>

#include <gtest/gtest.h>

#include "engine/model/piece_mesh.h"

namespace sunder {
namespace {

/// A frame of bodies, each with its meshes.
struct TestFrame {
  TestFrame() {
    auto meshes = std::make_shared<MeshStore>();
    for (int i = 0; i < 4; ++i) meshes->push_back(make_ball_mesh(1, MaterialIndex(0)));
    frame.meshes = meshes;
  }
  TestFrame& body(std::uint64_t key, std::uint64_t previous_key, std::vector<std::size_t> meshes) {
    FrameBody& made = frame.bodies.emplace_back();
    made.key = key;
    made.previous_key = previous_key;
    made.X_WB.position = Vec3(static_cast<double>(key), 0, 0);
    for (const std::size_t mesh : meshes) {
      frame.instances.push_back(
          {MeshIndex(mesh), static_cast<std::uint32_t>(frame.bodies.size() - 1)});
    }
    return *this;
  }
  Frame frame;
};

class BodyTracksTest : public ::testing::Test {
 protected:
  std::map<std::uint64_t, BodyTrack> found_;
  BodyTracks tracks_{PositionKeys(1e-3), RotationKeys(1e-3),
                     [this](const BodyTrack& track) { found_.emplace(track.key, track); }};
};

TEST_F(BodyTracksTest, HaveTheFramesInWhichABodyAndItsMeshesAreThere) {
  tracks_.add(0, TestFrame().body(0, 0, {0, 1, 2}).frame);
  tracks_.add(1, TestFrame().body(0, 0, {2, 0}).body(4, 0, {1}).frame);
  EXPECT_TRUE(found_.empty());
  tracks_.add(2, TestFrame().body(4, 4, {1}).frame);
  EXPECT_EQ(found_.size(), 1u);
  tracks_.add(3, TestFrame().body(4, 4, {1, 3}).frame);
  tracks_.finish();
  ASSERT_EQ(found_.size(), 2u);
  const BodyTrack &rest = found_.at(0), &piece = found_.at(4);
  EXPECT_EQ(rest.born, 0u);
  EXPECT_EQ(rest.gone, 2u);
  EXPECT_EQ(rest.parent_key, 0u);
  EXPECT_EQ(piece.born, 1u);
  EXPECT_EQ(piece.gone, kUntilEnd);
  EXPECT_EQ(piece.parent_key, 0u);
  const auto life = [](const BodyTrack& track, std::size_t mesh) {
    for (const InstanceSpan& span : track.spans) {
      if (span.mesh == MeshIndex(mesh)) return std::pair(span.begin, span.end);
    }
    return std::pair(0u, 0u);
  };
  EXPECT_EQ(rest.spans.size(), 3u);
  EXPECT_EQ(life(rest, 0), std::pair(0u, 2u));
  EXPECT_EQ(life(rest, 1), std::pair(0u, 1u));
  EXPECT_EQ(life(rest, 2), std::pair(0u, 2u));
  EXPECT_EQ(piece.spans.size(), 2u);
  EXPECT_EQ(life(piece, 1), std::pair(1u, kUntilEnd));
  EXPECT_EQ(life(piece, 3), std::pair(3u, kUntilEnd));
}

TEST_F(BodyTracksTest, HaveTheParentOfTheFrameBeforeEvenIfFramesAreSkipped) {
  tracks_.add(0, TestFrame().body(0, 0, {0}).frame);
  tracks_.skip(TestFrame().body(3, 0, {1}).body(4, 0, {2}).frame);
  tracks_.skip(TestFrame().body(4, 4, {2}).body(5, 3, {1}).body(6, 6, {3}).frame);
  tracks_.add(1, TestFrame().body(4, 4, {2}).body(5, 5, {1}).body(6, 6, {3}).frame);
  tracks_.add(2, TestFrame().body(5, 5, {1}).body(6, 6, {3}).body(7, 4, {2}).frame);
  tracks_.finish();
  const std::map<std::uint64_t, std::uint64_t> parents = {{0, 0}, {4, 0}, {5, 0}, {6, 6}, {7, 4}};
  ASSERT_EQ(found_.size(), parents.size());
  for (const auto& [key, parent] : parents) EXPECT_EQ(found_.at(key).parent_key, parent) << key;
}

TEST_F(BodyTracksTest, FollowThePointThatWasTheCentreOfMassAtBirth) {
  for (std::uint32_t number = 0; number < 3; ++number) {
    TestFrame made;
    made.body(0, 0, {0});
    FrameBody& body = made.frame.bodies[0];
    // The rest frame stays, and the centre of mass moves in it, as of an anchored rest.
    body.com_R = Vec3(number, 1, 0);
    body.X_WB = {Vec3(5, 1 + number, 0), Quat(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitZ()))};
    tracks_.add(number, made.frame);
  }
  tracks_.finish();
  const BodyTrack& track = found_.at(0);
  EXPECT_EQ(track.center_R, Vec3(0, 1, 0));
  for (const Vec3f& position : track.positions.keys())
    EXPECT_LT((position - Vec3f(5, 1, 0)).norm(), 1e-6f);
  EXPECT_EQ(track.rotations.keys().size(), 1u);
}

}  // namespace
}  // namespace sunder
