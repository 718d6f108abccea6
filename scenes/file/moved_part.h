// Moves and mirrors the parts of compounds.
#pragma once

#include <vector>

#include "engine/model/compound.h"
#include "scenes/file/placement.h"

namespace sunder::scenes {

/// Returns the convexes of a compound as parts, from which another compound can be made.
std::vector<Part> parts_of(const Compound& compound);
/// Returns a part mirrored at the plane x = 0, with the anchors of its two sides along x exchanged.
Part mirrored(Part part);
/// Returns a part moved rigidly by `X_FM`. Its anchored sides do not change.
Part moved(Part part, const Pose& X_FM);
/// Returns a part of a model as it is in a copy of the model: mirrored if the copy is, then moved.
Part placed(Part part, const Copy& copy);

}  // namespace sunder::scenes
