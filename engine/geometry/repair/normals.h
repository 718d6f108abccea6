// Shading normals for corners that have none.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/repair/surface.h"

namespace sunder {

/// A unit normal per corner: the file's where there is one, flipped outward; else the mean,
/// weighted by angle, of the faces around the vertex that no crease parts from the corner's own.
std::vector<Vec3f> shading_normals(const Surface& surface, double crease_cosine);

}  // namespace sunder
