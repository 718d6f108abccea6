// Tests of the view modes.
#include "render/view_mode.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "tests/render/synthetic_frame.h"

namespace sunder::render {
namespace {

/// Returns a frame of a moving block, a static beam and a sleeping ball.
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
  const Instance& drawn = frame.instances[instance];
  return (drawn.material.none() ? (*frame.meshes)[drawn.mesh.value]->material : drawn.material)
      .value;
}

Vec3f color_of(const Frame& frame, std::size_t instance) {
  return (*frame.materials)[material_of(frame, instance)].surface.color;
}

TEST(ViewMode, MaterialsLeavesTheFrameUnchanged) {
  const Frame frame = sample();
  EXPECT_EQ(&ViewMode("materials").shown(frame), &frame);
}

TEST(ViewMode, AnUnknownModeIsRefusedWithTheAllowedOnes) {
  try {
    ViewMode("x-ray");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("wireframe"), std::string::npos) << error.what();
  }
}

TEST(ViewMode, StaticAwakeAndSleepingBodiesHaveThreeColors) {
  const Frame frame = sample();
  ViewMode mode("asleep");
  const Frame shown = mode.shown(frame);
  EXPECT_NE(color_of(shown, 0), color_of(shown, 1));
  EXPECT_NE(color_of(shown, 1), color_of(shown, 2));
  EXPECT_NE(color_of(shown, 2), color_of(shown, 0));
  EXPECT_TRUE(shown.dust.empty()) << "dust would hide the colours";
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

TEST(ViewMode, AColorStaysFromFrameToFrameAndNoMeshIsMadeForIt) {
  Frame frame = sample();
  ViewMode mode("convexes");
  const Frame before = mode.shown(frame);
  frame.instances.erase(frame.instances.begin());
  const Frame after = mode.shown(frame);
  EXPECT_EQ(material_of(after, 1), material_of(before, 2));
  EXPECT_EQ(after.meshes, frame.meshes);
}

/// Returns the sample with a contact force of 1 kN upwards, and one island without the beam.
Frame inspected_sample() {
  Frame frame = sample();
  frame.debris.resize(2);
  auto inside = std::make_shared<Inspection>();
  inside->contacts = {{Vec3f(1, 2, 3), Vec3f(0, 1000, 0)}, {Vec3f(0, 0, 0), Vec3f(0, 0, 0)}};
  inside->boxes = {{Vec3f(0, 0, 0), Vec3f(1, 1, 1), 0}, {Vec3f(2, 0, 0), Vec3f(4, 1, 1), 1}};
  inside->islands = {0, 1, 0};
  inside->stresses = {0.1f, 0.95f, -1};
  frame.inspection = inside;
  return frame;
}

TEST(ViewMode, AModeThatNeedsInspectionRefusesAFrameWithoutIt) {
  for (const char* name : {"contacts", "stress", "islands", "broadphase"}) {
    ViewMode mode(name);
    EXPECT_TRUE(mode.needs_inspection());
    EXPECT_NO_THROW(mode.shown(inspected_sample())) << name;
    try {
      mode.shown(sample());
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find(name), std::string::npos) << said;
      EXPECT_NE(said.find("render the scene itself"), std::string::npos) << said;
    }
  }
  EXPECT_FALSE(ViewMode("exploded").needs_inspection());
}

TEST(ViewMode, AContactMarkShowsPointDirectionAndSizeOfItsForce) {
  Frame frame = inspected_sample();
  ViewMode mode("contacts");
  const Frame shown = mode.shown(frame);
  EXPECT_EQ(color_of(shown, 0), color_of(shown, 2)) << "solids are grey";
  EXPECT_TRUE(shown.debris.empty());
  ASSERT_EQ(mode.marks().spindles.size(), 1u) << "a contact without force has no mark";
  const Mark one = mode.marks().spindles[0];
  EXPECT_EQ(one.center_W, Vec3f(1, 2, 3));
  EXPECT_GT(one.half_axes_W.col(0).y(), 2 * one.half_axes_W.col(1).norm());
  EXPECT_NEAR(one.half_axes_W.determinant(),
              one.half_axes_W.col(0).norm() * one.half_axes_W.col(1).squaredNorm(), 1e-6)
      << "a mark turned inside out would be invisible";
  auto stronger = std::make_shared<Inspection>(*frame.inspection);
  stronger->contacts[0].force_W *= 8;
  frame.inspection = stronger;
  mode.shown(frame);
  const Mark more = mode.marks().spindles[0];
  EXPECT_NEAR(more.half_axes_W.col(0).norm(), 2 * one.half_axes_W.col(0).norm(), 1e-5);
  EXPECT_NE(more.color, one.color);
}

TEST(ViewMode, StressGoesFromBlueToRedAndIsGreyWhereThereIsNone) {
  ViewMode mode("stress");
  const Frame shown = mode.shown(inspected_sample());
  EXPECT_GT(color_of(shown, 0).z(), 3 * color_of(shown, 0).x());
  EXPECT_GT(color_of(shown, 1).x(), 3 * color_of(shown, 1).z());
  EXPECT_EQ(color_of(shown, 2).x(), color_of(shown, 2).z());
  EXPECT_TRUE(mode.marks().empty());
}

TEST(ViewMode, AnIslandHasOneColorWhichIsDarkerWhileItSleeps) {
  Frame frame = inspected_sample();
  ViewMode mode("islands");
  const Frame shown = mode.shown(frame);
  EXPECT_LT(color_of(shown, 2).norm(), color_of(shown, 0).norm());
  frame.bodies[2].asleep = false;
  const Frame awake = mode.shown(frame);
  EXPECT_EQ(color_of(awake, 2), color_of(awake, 0));
  EXPECT_NE(color_of(awake, 1), color_of(awake, 0)) << "a static body is in no island";
}

TEST(ViewMode, EveryBoxOfTheBroadPhaseIsDrawnInTheColorOfItsBodysState) {
  ViewMode mode("broadphase");
  mode.shown(inspected_sample());
  ASSERT_EQ(mode.marks().boxes.size(), 2u);
  const Mark& wide = mode.marks().boxes[1];
  EXPECT_EQ(wide.center_W, Vec3f(3, 0.5f, 0.5f));
  EXPECT_EQ(wide.half_axes_W.col(0), Vec3f(1, 0, 0));
  EXPECT_NE(wide.color, mode.marks().boxes[0].color);
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
