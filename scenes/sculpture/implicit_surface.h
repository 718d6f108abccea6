// Surfaces by formula, as meshes.
#pragma once

#include <functional>

#include "engine/geometry/raw_mesh.h"

namespace sunder::scenes {

/// A smooth function of a place: negative inside, 0 on the surface, and nowhere steeper than 2.
using Field = std::function<double(const Vec3&)>;

/// The surface where a field is 0, which lies within `box`, in triangles of a grid with cells of
/// `cell_m`, facing outward: a vertex for each sheet of it in a cell, moved onto the surface, with
/// the field's own normal (dual contouring). Watertight; what is thinner than a cell may be missed.
/// The same bits for any number of threads.
RawMesh triangulate(const Field& field, const Box& box, double cell_m);

}  // namespace sunder::scenes
