// Rotations from small or large turns; the same bits on every machine.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// The rotation by a rotation vector, exact for any angle.
Quat rotation_by(const Vec3& angle_W);
/// Its reverse, for up to half a turn.
Vec3 rotation_vector(const Quat& rotation);

}  // namespace sunder
