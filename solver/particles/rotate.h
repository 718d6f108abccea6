// Integration of a rotation by an angular velocity.
#pragma once

#include <cmath>

#include "engine/base/types.h"

namespace sunder::solver {

/// Turns a rotation by angular_velocity_W · dt_s; accurate for turns well below a radian. Used in
/// place of rotation_by() because it needs no sine, for thousands of particles per step.
inline void rotate(Quatf& rotation, const Vec3f& angular_velocity_W, float dt_s) {
  const Vec3f half = 0.5f * dt_s * angular_velocity_W;
  const Quatf change = Quatf(0, half.x(), half.y(), half.z()) * rotation;
  rotation.coeffs() += change.coeffs();
  rotation.coeffs() *= 1 / std::sqrt(rotation.coeffs().squaredNorm());
}

}  // namespace sunder::solver
