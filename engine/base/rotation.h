// Rotations from small or large turns; the same bits on every machine.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// The turn by a rotation vector.
Quat rotation_by(const Vec3& angle_W);

}  // namespace sunder
