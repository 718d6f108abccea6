// Interpolation of a camera between the keys of its path.
#pragma once

#include <span>

#include "engine/model/frame.h"

namespace sunder {

/// Returns `view` with its camera at `time_s` on the path through `keys`, whose times ascend. The
/// camera is at the first key before its time, and at the last key after its time. Velocities are
/// continuous and 0 at both ends, and the path overshoots no key. Without keys the camera is that
/// of `view`.
View along(std::span<const ViewKey> keys, const View& view, double time_s);

}  // namespace sunder
