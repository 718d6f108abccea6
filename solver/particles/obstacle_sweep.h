// What small spheres meet on their ways among obstacles.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/particles.h"

namespace sunder::solver {

/// Where a sphere meets an obstacle.
struct ObstacleTouch {
  double time = 1;     ///< Part of the way; 0 if it started inside.
  double depth_m = 0;  ///< At the end of the way, along the normal; > 0 if it started inside.
  Vec3 normal_W = Vec3::UnitY();   ///< Unit, out of the obstacle.
  Vec3 velocity_W = Vec3::Zero();  ///< Of the obstacle's surface there.
  std::uint32_t body = 0;          ///< Index in Obstacles::bodies.
};

/// A small sphere's way, straight, that takes the last duration_s of the step.
struct SphereWay {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double radius_m = 0;
  double duration_s = 0;
};

/// A shape as far as most ways need it: all in one place, as memory is what takes time.
struct PlacedObstacle {
  std::uint32_t shape = 0;
  std::span<const ConvexPolyhedron::Face> faces;  ///< None of a ball.
  Vec3f min, max;                                 ///< Swept, in W.
  Vec3f center_W;                                 ///< Of its own box.
  Vec3f half_m;
  Mat3f rotation_BW;
  Vec3f velocity_W = Vec3f::Zero(), angular_velocity_W = Vec3f::Zero();  ///< Of its box.
};

/// Obstacles as they stand at the end of a step.
struct PlacedObstacles {
  Obstacles obstacles;
  std::vector<Mat3> rotations_WB;  ///< Per body.
  std::vector<PlacedObstacle> shapes;
};

/// The first touch of each of up to eight ways with those shapes of `placed` that are `near`;
/// obstacles move meanwhile, too.
void sweep_spheres(const PlacedObstacles& placed, std::span<const std::uint32_t> near,
                   std::span<const SphereWay> ways,
                   std::span<std::optional<ObstacleTouch>> touches);

}  // namespace sunder::solver
