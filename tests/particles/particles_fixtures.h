// Test fixture: obstacles and emitting faces for particles.
#pragma once

#include <deque>
#include <vector>

#include "engine/model/particles.h"

namespace sunder {

/// Bodies of one box or ball each, with the hulls that they refer to.
class TestObstacles {
 public:
  /// Adds a box about its rest frame's origin, and returns its index.
  std::size_t add_box(const Vec3& center, const Vec3& half,
                      const Quat& rotation = Quat::Identity()) {
    hulls_.push_back(make_box(-half, half));
    ObstacleShape shape;
    shape.hull = &hulls_.back();
    shape.box_R = {-half, half};
    shape.volume_m3 = 8 * half.prod();
    return add({center, rotation}, shape);
  }
  std::size_t add_ball(const Vec3& center, double radius_m) {
    ObstacleShape shape;
    shape.radius_m = radius_m;
    return add({center, Quat::Identity()}, shape);
  }
  void set_velocity(std::size_t body, const Vec3& velocity) {
    bodies[body].velocity_W = velocity;
    bodies[body].moves = true;
  }
  /// Moves all bodies by their velocities, as the solver would before particles advance.
  void advance(double dt_s) {
    for (ObstacleBody& body : bodies) body.X_WB.position += dt_s * body.velocity_W;
  }
  Obstacles view() const { return {bodies, shapes, ground_m}; }

  std::vector<ObstacleBody> bodies;
  std::vector<ObstacleShape> shapes;
  double ground_m = 0;

 private:
  std::size_t add(const Pose& X_WB, ObstacleShape shape) {
    ObstacleBody body;
    body.key = static_cast<std::uint32_t>(bodies.size());
    body.X_WB = X_WB;
    shape.body = body.key;
    bodies.push_back(body);
    shapes.push_back(shape);
    return bodies.size() - 1;
  }
  std::deque<ConvexPolyhedron> hulls_;
};

/// A horizontal square that faces down, with its centre at a point.
struct TestFace {
  explicit TestFace(const Vec3& center, double width_m = 1) {
    const double w = 0.5 * width_m;
    corners = {center + Vec3(-w, 0, -w), center + Vec3(w, 0, -w), center + Vec3(w, 0, w),
               center + Vec3(-w, 0, w)};
  }
  ExposedPolygon emission(const DebrisEmission& crumbling) const {
    ExposedPolygon face;
    face.corners_W = corners;
    face.normal_W = -Vec3::UnitY();
    face.crumbling = crumbling;
    return face;
  }
  std::vector<Vec3> corners;
};

}  // namespace sunder
