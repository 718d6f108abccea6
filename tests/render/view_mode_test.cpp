// What every view mode makes of a frame.
#include "render/view_mode.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

/// A block that moves, a beam that is held, a ball asleep.
Frame sample() {
  SyntheticFrame synthetic;
  synthetic.add_box(Vec3(0, 0, 0), Vec3(1, 1, 1), Stuff::kBrick);
  synthetic.add_box(Vec3(2, 0, 0), Vec3(3, 1, 1), Stuff::kWood);
  synthetic.add_ball(Vec3(5, 1, 0), 0.5, Stuff::kSteel);
  Frame& frame = synthetic.frame;
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) frame.bodies[i].key = 10 + i;
  frame.bodies[1].is_static = true;
  frame.bodies[2].asleep = true;
  frame.dust.resize(3);
  return frame;
}

std::uint32_t material_of(const Frame& frame, std::size_t instance) {
  return (*frame.meshes)[frame.instances[instance].mesh.value]->material.value;
}

Vec3f color_of(const Frame& frame, std::size_t instance) {
  return (*frame.materials)[material_of(frame, instance)].surface.color;
}

TEST(ViewMode, MaterialsAreTheFrameItself) {
  const Frame frame = sample();
  EXPECT_EQ(&ViewMode("materials").shown(frame), &frame);
}

TEST(ViewMode, AnUnknownOneIsRefusedWithWhatIsAllowed) {
  try {
    ViewMode("x-ray");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("wireframe"), std::string::npos) << error.what();
  }
}

TEST(ViewMode, WhatIsHeldAwakeAndAsleepHasThreeColors) {
  const Frame frame = sample();
  ViewMode mode("asleep");
  const Frame shown = mode.shown(frame);
  EXPECT_NE(color_of(shown, 0), color_of(shown, 1));
  EXPECT_NE(color_of(shown, 1), color_of(shown, 2));
  EXPECT_NE(color_of(shown, 2), color_of(shown, 0));
  EXPECT_TRUE(shown.dust.empty()) << "it would veil the colours";
  Frame woken = frame;
  woken.bodies[2].asleep = false;
  EXPECT_EQ(color_of(mode.shown(woken), 2), color_of(shown, 0));
}

TEST(ViewMode, ACompoundHasOneColorAndItsConvexesMany) {
  Frame frame = sample();
  MeshStore meshes = *frame.meshes;
  for (int i = 0; i < 20; ++i) {
    frame.instances.push_back({MeshIndex(meshes.size()), 0});
    meshes.push_back(std::make_shared<const Mesh>(*meshes[0]));
  }
  frame.meshes = std::make_shared<const MeshStore>(std::move(meshes));
  const auto colors = [&](const char* name) {
    ViewMode mode(name);
    const Frame& shown = mode.shown(frame);
    std::set<std::uint32_t> found = {material_of(shown, 0)};
    for (std::size_t i = 3; i < shown.instances.size(); ++i) found.insert(material_of(shown, i));
    return found.size();
  };
  EXPECT_EQ(colors("compounds"), 1u);
  EXPECT_EQ(colors("wireframe"), 1u);
  EXPECT_GE(colors("convexes"), 6u);
}

TEST(ViewMode, AColorStaysFromFrameToFrameAndItsMeshIsMadeOnce) {
  Frame frame = sample();
  ViewMode mode("convexes");
  const Frame before = mode.shown(frame);
  frame.instances.erase(frame.instances.begin());
  const Frame after = mode.shown(frame);
  EXPECT_EQ((*after.meshes)[after.instances[1].mesh.value],
            (*before.meshes)[before.instances[2].mesh.value]);
  EXPECT_EQ(after.meshes->size(), before.meshes->size());
}

TEST(ViewMode, ExplodedPiecesMoveApartAndNotIntoTheGround) {
  const Frame frame = sample();
  ViewMode mode("exploded");
  const Frame shown = mode.shown(frame);
  const auto distance = [](const Frame& of, std::size_t a, std::size_t b) {
    return (of.bodies[a].X_WB.position - of.bodies[b].X_WB.position).norm();
  };
  EXPECT_NEAR(distance(shown, 0, 2), 1.5 * distance(frame, 0, 2), 1e-9);
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    EXPECT_GE(shown.bodies[i].X_WB.position.y(), frame.bodies[i].X_WB.position.y());
  }
  EXPECT_EQ(shown.materials, frame.materials);
}

}  // namespace
}  // namespace sunder::render
