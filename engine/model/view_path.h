// Where a camera goes between the keys of its path.
#pragma once

#include <span>

#include "engine/model/frame.h"

namespace sunder {

/// `view` as its camera goes through keys, whose times ascend: at the first until then, at the last
/// from then on. Velocities are continuous, 0 at both ends, and overshoot no key. Without keys it
/// stays as it is.
View along(std::span<const ViewKey> keys, const View& view, double time_s);

}  // namespace sunder
