#include "engine/base/rotation.h"

#include <numbers>

#include "engine/base/trigonometry.h"

namespace sunder {

Quat rotation_by(const Vec3& angle_W) {
  const double angle = angle_W.norm();
  if (angle < 1e-3) {  // sin(x/2)/x to 1e-15
    const double square = angle * angle;
    const Vec3 v = (0.5 - square / 48) * angle_W;
    return Quat(1 - square / 8, v.x(), v.y(), v.z()).normalized();
  }
  const SinCos half = sin_cos(0.5 * angle);
  const Vec3 v = (half.sin / angle) * angle_W;
  return Quat(half.cos, v.x(), v.y(), v.z());
}

Vec3 rotation_vector(const Quat& rotation) {
  const double sine = rotation.vec().norm();
  if (!(sine > 0)) return Vec3::Zero();
  double angle = 2 * arc_tangent(sine, rotation.w());
  if (rotation.w() < 0) angle -= 2 * std::numbers::pi;  // the rotation by the smaller angle
  return angle / sine * rotation.vec();
}

}  // namespace sunder
