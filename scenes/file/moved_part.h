// Parts of compounds, moved and mirrored.
#pragma once

#include <vector>

#include "engine/model/compound.h"
#include "scenes/file/placement.h"

namespace sunder::scenes {

/// The convexes of a compound, to be made one again with others.
std::vector<Part> parts_of(const Compound& compound);
/// A part mirrored at x = 0; what held it from one side does so from the other.
Part mirrored(Part part);
/// A part moved rigidly. Anchors are left as they are.
Part moved(Part part, const Pose& X_FM);
/// A part as a copy has it.
Part placed(Part part, const Copy& copy);

}  // namespace sunder::scenes
