// Shading normals of a repaired surface.
#pragma once

#include <vector>

#include "engine/geometry/repair/surface.h"

namespace sunder {

/// Returns a unit normal for each corner: that of the file, flipped outward, if there is one; else
/// the angle-weighted mean over the faces around the vertex that no crease separates from the
/// corner's. The normals of two faces at a crease have a cosine below `crease_cosine`.
std::vector<Vec3f> shading_normals(const Surface& surface, double crease_cosine);

}  // namespace sunder
