// Symptom: a cube flew through a wall. Cause: a pair that was too far apart for the narrow phase
// stayed in the list after its boxes had separated. A shape that was removed did not find the pair
// by its box, and a new shape in its slot was taken for the old one. A pair is now removed when its
// boxes separate, whether the narrow phase needs it or not.
#include <gtest/gtest.h>

#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressPairs, OfRemovedShapesAreNotTakenForPairsOfNewShapes) {
  RigidOptions options;
  options.gravity_W = Vec3::Zero();
  RigidWorld world(options);
  const BodyId cube = world.add(W::box(Vec3::Constant(0.2), Vec3::Zero()));
  // Turned plates, whose bounding boxes overlap the cube at a corner that the plates do not reach.
  const auto plate = [](double side) {
    BodyDesc desc = W::box(Vec3(0.1, 2, 1), Vec3(0.8, 0.8 * side, 0));
    desc.X_WB.rotation = Quat(Eigen::AngleAxisd(0.25 * std::numbers::pi * side, Vec3::UnitZ()));
    return desc;
  };
  const BodyId left = world.add(plate(1)), right = world.add(plate(-1));
  BodyState state = world.state(cube);
  for (const double x : {0.0, 0.001, -0.5}) {
    state.X_WB.position.x() = x;
    world.physics().set_state(cube, state);
    world.step(1.0 / 60, 1);
  }
  // Bodies in place of the plates, of two shapes each, one of which is in the cube's way: the
  // shapes take the free slots in another order.
  const auto wall = [](double side, double x) {
    BodyDesc desc = W::fixed(W::box(Vec3::Ones(), Vec3(0.8, 0.8 * side, 0)));
    desc.shapes.push_back(desc.shapes[0]);
    for (const double offset_m : {0.0, 50.0}) {
      const Vec3 middle = Vec3(x + offset_m, 0, 0) - desc.X_WB.position;
      desc.shapes[offset_m > 0 ? 0 : 1].hull =
          W::keep(make_box(middle - Vec3(0.1, 1, 1), middle + Vec3(0.1, 1, 1)));
    }
    return desc;
  };
  world.replace({left, right}, {wall(-1, 0.5), wall(1, 20)});
  state.velocity_W = Vec3(5, 0, 0);
  world.physics().set_state(cube, state);
  for (int i = 0; i < 60; ++i) world.step(1.0 / 60, 1);
  EXPECT_LT(world.state(cube).X_WB.position.x(), 0.31);
}

}  // namespace
}  // namespace sunder::solver
