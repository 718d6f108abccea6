// Meshes of implicit surfaces.
#pragma once

#include <functional>

#include "engine/geometry/raw_mesh.h"

namespace sunder::scenes {

/// A smooth function of position: negative inside, 0 on the surface, with a gradient of at most 2.
using Field = std::function<double(const Vec3&)>;

/// Returns the zero surface of a field, which must be within `box`, as a watertight mesh of
/// outward triangles (dual contouring on a grid with cells of `cell_m`). Each sheet of the surface
/// in a cell has one vertex, which is moved onto the surface, with the field's gradient as normal.
/// Details thinner than a cell may be missed. Bit-identical for any number of threads.
RawMesh triangulate(const Field& field, const Box& box, double cell_m);

}  // namespace sunder::scenes
