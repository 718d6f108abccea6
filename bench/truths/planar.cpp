// Validation against Box2D: our solver in three dimensions comes to rest in the same positions as
// Box2D in two, and the same structures stand or fall.
#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/truths/truth.h"
#include "solver/planar/planar_physics.h"

namespace sunder::truths {
namespace {

using Build = std::function<void(RigidWorld&)>;
constexpr double kTime_s = 4;

std::vector<BodyState> states_of(const RigidWorld& world) {
  std::vector<BodyState> states;
  for (std::size_t i = 0; i < world.size(); ++i) states.push_back(world.state(world.id(i)));
  return states;
}

std::vector<BodyState> planar_rest(const Build& build, double block_m) {
  solver::PlanarOptions options;
  options.piece_m = block_m;
  options.sleeping = false;
  RigidWorld world(solver::make_planar_physics(options));
  build(world);
  world.run(kTime_s, 1.0 / 120, 4);
  return states_of(world);
}

std::vector<BodyState> solid_rest(const Build& build, const Preset& preset) {
  PresetWorld world(preset);
  build(world);
  world.run(kTime_s);
  return states_of(world);
}

/// Largest difference of a pose from Box2D's, in blocks; rotation counts by the motion of corners.
Measure difference(const Build& build, double block_m) {
  return [=](const Preset& preset) {
    const std::vector<BodyState> a = planar_rest(build, block_m), b = solid_rest(build, preset);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Pose &x = a[i].X_WB, &y = b[i].X_WB;
      const double turn = 2 * (x.rotation.conjugate() * y.rotation).vec().norm();
      largest = std::max(largest, (x.position - y.position).norm() / block_m + 0.5 * turn);
    }
    return largest;
  };
}

/// Number of solvers, of both, with a wrong prediction whether the structure falls (loses height).
Measure wrong_predictions(const Build& build, double block_m, double start_m, bool falls) {
  return [=](const Preset& preset) {
    int wrong = 0;
    for (const auto& rest : {planar_rest(build, block_m), solid_rest(build, preset)}) {
      double highest_m = 0;
      for (const BodyState& state : rest) highest_m = std::max(highest_m, state.X_WB.position.y());
      wrong += (highest_m < start_m - 0.05) != falls;
    }
    return wrong;
  };
}

void build_wall(RigidWorld& world) {
  world.add(W::ground());
  for (int row = 0; row < 8; ++row)
    for (int i = 0; i < 6; ++i)
      world.add(W::box(Vec3(0.4, 0.2, 0.2), Vec3((i + 0.4 * (row % 2)) * 0.4, 0.2 * row + 0.1, 0)));
}

void build_pyramid(RigidWorld& world) {
  world.add(W::ground());
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10 - row; ++i)
      world.add(W::box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0)));
}

/// An arch of 11 stones in a semicircle of radius 1, `thickness` m thick.
Build arch(double thickness) {
  return [=](RigidWorld& world) {
    world.add(W::with_friction(W::ground(), 1));
    for (int i = 0; i < 11; ++i) world.add(W::voussoir(i, 11, thickness));
  };
}

/// A stack of four bricks whose overhangs are `factor` times those in balance.
Build overhang(double factor) {
  return [=](RigidWorld& world) {
    world.add(W::ground());
    world.add(W::fixed(W::box(Vec3(1, 1, 0.5), Vec3(0, 0.5, 0))));
    double x = 0;
    for (int level = 1; level <= 4; ++level) {
      x += factor * 0.5 / (5 - level);
      world.add(W::box(Vec3(1, 0.2, 0.5), Vec3(x, 0.9 + 0.2 * level, 0)));
    }
  };
}

}  // namespace

Truths planar_truths() {
  const char* box2d = "Box2D 2.4";
  const char* both = "statics, and Box2D 2.4";
  return {
      truth(25, "wall of 48: from its rest in the plane, in bricks", "", box2d, 0.01,
            difference(build_wall, 0.4), {0.001, 0.001, 0.001, 0.001}),
      truth(25, "pyramid of 55: from its rest in the plane, in boxes", "", box2d, 0.01,
            difference(build_pyramid, 1), {0.001, 0.001, 0.001, 0.001}),
      truth(25, "arch of 11: from its rest in the plane, in stones", "", box2d, 0.01,
            difference(arch(0.14), 0.28), {0.001, 0.001, 0.001, 0.001}),
      truth(25, "arch of .09 falls: wrong verdicts", "", both, 0,
            wrong_predictions(arch(0.09), 0.28, 1, true), {0, 0, 0, 0}),
      truth(25, "arch of .125 stands: wrong verdicts", "", both, 0,
            wrong_predictions(arch(0.125), 0.28, 1, false), {0, 0, 0, 0}),
      truth(25, "overhang of .96 stands: wrong verdicts", "", both, 0,
            wrong_predictions(overhang(0.96), 0.5, 1.7, false), {0, 0, 0, 0}),
      truth(25, "overhang of 1.03 falls: wrong verdicts", "", both, 0,
            wrong_predictions(overhang(1.03), 0.5, 1.7, true), {0, 0, 0, 0}),
  };
}

}  // namespace sunder::truths
