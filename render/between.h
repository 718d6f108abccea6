// What is seen between two frames.
#pragma once

#include "engine/model/frame.h"

namespace sunder::render {

/// The second frame, `part` of the way from the first; 1: as it is. Bodies and the camera go
/// straight and turn evenly; what the first frame has not, or all if there is none, goes back as
/// fast as it moves. Debris that keeps its place in the list does as bodies do; dust stays.
Frame between(const Frame* first, const Frame& second, double part);

}  // namespace sunder::render
