// Piles of bodies that several benchmarks use.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/model/physics.h"

namespace sunder::bench {

/// Bodies to add to a physics world, and the hulls that their shapes point to.
struct Pile {
  std::vector<BodyDesc> bodies;
  std::vector<std::unique_ptr<ConvexPolyhedron>> hulls;

  void ground(const Vec3& normal_W = Vec3::UnitY(), const Vec3& point_W = Vec3::Zero()) {
    BodyDesc desc;
    desc.is_static = true;
    ShapeDesc shape;
    shape.kind = ShapeDesc::Kind::kHalfSpace;
    shape.normal_R = normal_W;
    shape.center_R = point_W;
    desc.shapes = {shape};
    bodies.push_back(desc);
  }
  void convex(ConvexPolyhedron polyhedron, const Vec3& center_W, double density = 2000) {
    hulls.push_back(std::make_unique<ConvexPolyhedron>(std::move(polyhedron)));
    const MassProperties solid = mass_properties(*hulls.back());
    BodyDesc desc;
    desc.com_R = solid.centroid;
    desc.X_WB.position = center_W;
    desc.mass_kg = density * solid.volume_m3;
    desc.inertia_B = density * solid.inertia();
    ShapeDesc shape;
    shape.hull = hulls.back().get();
    desc.shapes = {shape};
    bodies.push_back(desc);
  }
  void box(const Vec3& size, const Vec3& center_W, double density = 2000) {
    convex(make_box(-0.5 * size, 0.5 * size), center_W, density);
  }
  void ball(double mass_kg, double radius_m, const Vec3& center_W, const Vec3& velocity_W) {
    BodyDesc desc;
    desc.X_WB.position = center_W;
    desc.velocity_W = velocity_W;
    desc.mass_kg = mass_kg;
    desc.inertia_B = Mat3::Identity() * (0.4 * mass_kg * radius_m * radius_m);
    ShapeDesc shape;
    shape.kind = ShapeDesc::Kind::kSphere;
    shape.radius_m = radius_m;
    desc.shapes = {shape};
    bodies.push_back(desc);
  }
};

/// Returns `count` hulls of 8 to 16 vertices, 0.1 to 0.5 m in size, in a grid between four walls.
inline Pile rubble(int count, std::uint64_t seed = 1) {
  constexpr double kPitch_m = 0.45;
  Pile set;
  const int side = std::max(3, static_cast<int>(std::lround(std::cbrt(count / 2.0))));
  const double half = 0.5 * side * kPitch_m + 0.3;
  set.ground();
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    set.ground(normal, -half * normal);
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const double size = random.uniform(0.1, 0.5);
    std::vector<Vec3> points(8 + random.below(9));
    for (Vec3& point : points) point = 0.5 * size * random.direction();
    const Vec3 cell(i % side - 0.5 * side + 0.5, i / side / side,
                    i / side % side - 0.5 * side + 0.5);
    const Vec3 jitter(random.uniform(-0.05, 0.05), 0.4, random.uniform(-0.05, 0.05));
    set.convex(make_hull(points), kPitch_m * cell + jitter);
  }
  return set;
}

/// Returns a running bond of `columns` by `rows` bricks. Courses are shifted by 0.4 of a brick, as
/// end bricks would fall with half of one.
inline Pile wall(int columns, int rows) {
  Pile set;
  set.ground();
  const Vec3 brick(0.4, 0.2, 0.2);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      set.box(brick, Vec3((column + 0.4 * (row % 2)) * brick.x(), (row + 0.5) * brick.y(), 0));
  return set;
}

inline Pile pyramid(int base) {
  Pile set;
  set.ground();
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i)
      set.box(Vec3(1, 1, 1), Vec3((i + 0.5 * row) * 1.02, row + 0.5, 0));
  return set;
}

inline Pile stack(int count) {
  Pile set;
  set.ground();
  for (int i = 0; i < count; ++i) set.box(Vec3(1, 1, 1), Vec3(0, i + 0.5, 0));
  return set;
}

inline Pile touching_cubes(int side) {
  Pile set;
  set.ground();
  for (int i = 0; i < side * side * side; ++i)
    set.box(Vec3(0.2, 0.2, 0.2), 0.2 * Vec3(i % side, i / side / side + 0.5, i / side % side));
  return set;
}

}  // namespace sunder::bench
