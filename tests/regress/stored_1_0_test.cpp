// Files of version 1.0, which all versions 1.x read (docs/stability.md): tests/data/1.0/scene.toml,
// and the recording of its run. Neither file may be changed or written again.
#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/recording/recording.h"
#include "engine/io/statistics.h"
#include "scenes/load.h"

namespace sunder {
namespace {

const std::string kFolder = SUNDER_ROOT "/tests/data/1.0/";

TEST(Stored10, TheRecordingIsReadWithTheStatesOfItsRun) {
  RecordingReader recording(kFolder + "recording.take");
  StateHash hash;
  FramePtr frame, last;
  std::size_t breaks = 0;
  while ((frame = recording.next())) {
    hash.take(frame);
    breaks += frame->breaks.size();
    last = frame;
  }
  EXPECT_EQ(recording.damage(), "");
  EXPECT_TRUE(recording.is_complete());
  EXPECT_EQ(recording.frames(), 31u);
  EXPECT_EQ(hash.hex(), "156201a8bfb703d7");
  EXPECT_EQ(breaks, 2u);
  ASSERT_TRUE(last);
  EXPECT_DOUBLE_EQ(last->time_s, 0.5);
  EXPECT_EQ(last->report.counts.bodies, 13u);
  ASSERT_TRUE(last->names);
  const auto named = [&](const std::string& name) {
    for (const FrameBody& body : last->bodies) {
      if (body.name != kNoName && (*last->names)[body.name] == name) return body;
    }
    ADD_FAILURE() << "no body of " << name;
    return FrameBody();
  };
  constexpr double kStored_m = 1e-3;  // the precision of positions in a recording, or less
  EXPECT_LT((named("cart").X_WB.position - Vec3(-2.5, 0.2, 2)).norm(), kStored_m);
  EXPECT_LT((named("torus").X_WB.position - Vec3(-1.66907, 0.464478, 0)).norm(), kStored_m);
  EXPECT_GT(named("marble").X_WB.position.y(), 1.49);  // hangs
}

TEST(Stored10, TheSceneIsReadKeyByKey) {
  const Scene scene = scenes::load_scene(kFolder + "scene.toml");
  EXPECT_EQ(scene.warnings.size(), 0u);
  EXPECT_EQ(scene.seed, 7u);
  EXPECT_EQ(scene.duration_s, 0.5);
  EXPECT_EQ(scene.gravity_W, Vec3(0, -9.81, 0));
  EXPECT_EQ(scene.accuracy.substeps, 4);
  EXPECT_EQ(scene.limits.bodies, 2000u);
  EXPECT_EQ(scene.ground.friction, 0.6);
  EXPECT_EQ(scene.view.eye_W, Vec3(4, 3, 8));
  const MaterialIndex chalk = scenes::material_named(scene, "chalk");
  EXPECT_EQ(scene.materials[chalk.value].density_kg_m3, 1500);
  ASSERT_EQ(scene.solids.size(), 9u);
  EXPECT_EQ(scene.solids[0].name, "block");
  EXPECT_NEAR(volume(scene.solids[1].compound), 1, 1e-12);
  ASSERT_EQ(scene.balls.size(), 1u);
  EXPECT_EQ(scene.balls[0].radius_m, 0.2);
  ASSERT_EQ(scene.joints.size(), 1u);
  ASSERT_EQ(scene.shots.size(), 1u);
  EXPECT_NEAR(scene.shots[0].ball.velocity_W.norm(), 25, 1e-9);
  ASSERT_EQ(scene.blasts.size(), 1u);
  EXPECT_EQ(scene.blasts[0].tnt_kg, 0.01);
  ASSERT_EQ(scene.removals.size(), 1u);
  ASSERT_EQ(scene.drives.size(), 1u);
  EXPECT_EQ(scene.drives[0].force_N, 5000);
  ASSERT_EQ(scene.moves.size(), 1u);
  EXPECT_EQ(scene.moves[0].release_s, 0.4);
}

}  // namespace
}  // namespace sunder
