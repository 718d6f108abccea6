// A heap of hulls that have come to rest, and rays into it, for benchmarks of queries.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/hull.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::bench {

/// Returns a scene of `count` hulls of 8 to 16 vertices, 0.1 to 0.5 m in size, that will fall into
/// a heap.
inline Scene heap_scene(int count) {
  Scene scene;
  scene.materials = scenes::builtin_materials();
  Random random(1, 0);
  const int side = static_cast<int>(std::cbrt(count)) + 1;
  for (int i = 0; i < count; ++i) {
    std::vector<Vec3> points;
    const double size_m = random.uniform(0.1, 0.5);
    const int vertices = 8 + static_cast<int>(random.uniform(0, 9));
    for (int k = 0; k < vertices; ++k) points.push_back(0.5 * size_m * random.direction());
    Part part;
    part.polyhedron = make_hull(points);
    part.material = scenes::material_named(scene, "steel");
    Solid solid;
    solid.compound = scenes::make_compound({part});
    solid.X_WR.position = 0.5 * Vec3(i % side, 1 + i / (side * side), i / side % side);
    scene.solids.push_back(std::move(solid));
  }
  return scene;
}

/// Returns a world of a scene after two seconds, on one thread.
inline World settled(Scene scene) {
  World world = scenes::make_world(std::move(scene));
  world.set_threads(1);
  for (int i = 0; i < 120; ++i) world.step(1.0 / 60);
  return world;
}

/// Returns the start of a ray into the heap, and the way to the centre of a body, 20 m away.
inline std::pair<Vec3, Vec3> ray_into(const World& world, Random& random) {
  const BodyArrays& bodies = world.bodies();
  const Vec3 to = bodies.position_W[random.bits() % bodies.key.size()];
  const Vec3 from = to + 20 * (random.direction() + 1.2 * Vec3::UnitY()).normalized();
  return {from, to - from};
}

}  // namespace sunder::bench
