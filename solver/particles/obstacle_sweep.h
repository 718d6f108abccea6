// Sweeps of small spheres along straight paths among obstacles.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/particles.h"

namespace sunder::solver {

/// The contact of a swept sphere with an obstacle.
struct SphereContact {
  double time = 1;     ///< Fraction of the path; 0 if the sphere started inside.
  double depth_m = 0;  ///< Penetration at the end of the path; > 0 if the sphere started inside.
  Vec3 normal_W = Vec3::UnitY();   ///< Unit normal, out of the obstacle.
  Vec3 velocity_W = Vec3::Zero();  ///< Velocity of the obstacle's surface at the contact.
  std::uint32_t body = 0;          ///< Index in Obstacles::bodies.
};

/// The straight path of a small sphere during the last duration_s of the step.
struct SpherePath {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double radius_m = 0;
  double duration_s = 0;
};

/// The data of a shape that most sweeps read, kept together because memory access dominates.
struct PlacedObstacle {
  std::uint32_t shape = 0;
  std::span<const ConvexPolyhedron::Face> faces;  ///< Empty for a ball.
  Vec3f min, max;                                 ///< Swept box in W.
  Vec3f center_W;                                 ///< Centre of the shape's own box.
  Vec3f half_m;                                   ///< Half extents of the shape's own box.
  Mat3f rotation_BW;
  /// Velocity at center_W and angular velocity of the body.
  Vec3f velocity_W = Vec3f::Zero(), angular_velocity_W = Vec3f::Zero();
};

/// Obstacles with their poses at the end of a step.
struct PlacedObstacles {
  Obstacles obstacles;
  std::vector<Mat3> rotations_WB;  ///< Rotation of each body.
  std::vector<PlacedObstacle> shapes;
};

/// Finds the first contact of each of up to eight paths with the shapes `near` (indices into
/// `placed.shapes`), taking the motion of the obstacles into account.
void sweep_spheres(const PlacedObstacles& placed, std::span<const std::uint32_t> near,
                   std::span<const SpherePath> paths,
                   std::span<std::optional<SphereContact>> touches);

}  // namespace sunder::solver
