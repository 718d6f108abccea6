// Symptom: a cube flew through a wall. Cause: a pair that was too far apart
// to need a look stayed in the list when its boxes had parted; shapes that went did not find it by
// their boxes, and what came into their slots was taken for what it had been a pair with. Now a
// pair whose boxes part goes, looked at or not.
#include <gtest/gtest.h>

#include "bench/truths/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

TEST(RegressPairs, OfShapesThatGoAreNotTakenForThoseOfWhatComes) {
  RigidOptions options;
  options.gravity_W = Vec3::Zero();
  RigidWorld world(options);
  const BodyId cube = world.add(W::box(Vec3::Constant(0.2), Vec3::Zero()));
  // Plates that cut off corners of a box that the cube is at a corner of, too.
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
  // Bodies where the plates were, of two shapes each, of which one stands in the way: slots are
  // taken in some other order.
  const auto wall = [](double side, double x) {
    BodyDesc desc = W::fixed(W::box(Vec3::Ones(), Vec3(0.8, 0.8 * side, 0)));
    desc.shapes.push_back(desc.shapes[0]);
    for (const double way : {0.0, 50.0}) {
      const Vec3 middle = Vec3(x + way, 0, 0) - desc.X_WB.position;
      desc.shapes[way > 0 ? 0 : 1].hull =
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
