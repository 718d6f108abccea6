// Vectors, rotations and poses: Eigen under the short names every room uses.
//
// double for geometry and body positions, float (suffix f) for solver inner loops and drawing.
// Poses follow monogram notation: X_WB is the pose of B in W, and X_WB * point_B == point_W.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sunder {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Vec3f = Eigen::Vector3f;
using Mat3f = Eigen::Matrix3f;
using Quatf = Eigen::Quaternionf;

/// A rigid placement: rotation, then translation.
struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();

  Vec3 operator*(const Vec3& point) const { return rotation * point + position; }
  Pose operator*(const Pose& inner) const {
    return {*this * inner.position, rotation * inner.rotation};
  }
  Pose inverse() const {
    const Quat back = rotation.conjugate();
    return {back * -position, back};
  }
};

/// An axis-aligned box; empty (min > max) until extended.
struct Box {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);

  void extend(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void extend(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  bool empty() const { return (min.array() > max.array()).any(); }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 extent() const { return max - min; }
  bool overlaps(const Box& other) const {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
};

}  // namespace sunder
