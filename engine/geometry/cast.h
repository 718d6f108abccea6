// Intersections of rays and moving balls with convexes, and overlaps of balls and boxes with them.
#pragma once

#include <array>
#include <optional>

#include "engine/geometry/convex_polyhedron.h"

namespace sunder {

/// A ball that moves straight on; a ray if its radius is 0.
struct MovingBall {
  Vec3 from = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();  ///< Unit.
  double reach_m = 0;              ///< Length of the way.
  double radius_m = 0;
};

/// The first point at which a moving ball touches a surface.
struct SurfaceHit {
  double distance_m = 0;  ///< Of the ball's centre from its start; 0 if it overlaps at the start.
  /// Unit normal of the surface, outward; against the motion if the ball overlaps at the start.
  Vec3 normal = Vec3::UnitY();
};

// All in the frame of the second argument; nothing is found beyond the reach.
std::optional<SurfaceHit> cast(const MovingBall& ball, const ConvexPolyhedron& convex);
std::optional<SurfaceHit> cast_at_ball(const MovingBall& ball, const Vec3& center, double radius_m);
/// The half-space below a plane.
std::optional<SurfaceHit> cast(const MovingBall& ball, const Plane& plane);
/// A triangle that only its front stops, from which its corners are counter-clockwise.
std::optional<SurfaceHit> cast_at_front(const MovingBall& ball, const std::array<Vec3, 3>& corners);

/// Returns the distance from a point to a convex; 0 inside.
double distance(const ConvexPolyhedron& convex, const Vec3& point);
/// Returns true if the distance from a point to a convex is at most `radius_m`.
bool is_within(const ConvexPolyhedron& convex, const Vec3& point, double radius_m);
/// Returns the distance from a point to a box; 0 inside.
inline double distance(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).norm();
}
/// Returns true if a box, given in the frame Q, overlaps a convex, whose frame has the pose X_QC.
bool overlaps(const ConvexPolyhedron& convex, const Pose& X_QC, const Box& box_Q);

}  // namespace sunder
