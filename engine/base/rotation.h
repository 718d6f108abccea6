// Conversion between rotation vectors and quaternions. Gives the same bits on every machine.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Returns the rotation by a rotation vector (axis times angle in rad); any angle is allowed.
Quat rotation_by(const Vec3& angle_W);
/// Returns the rotation vector of a rotation, with an angle of at most pi. The quaternion is unit.
Vec3 rotation_vector(const Quat& rotation);

}  // namespace sunder
