// The last tier of repair: a new, closed surface around whatever a mesh seems to enclose.
#pragma once

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// The surface where the mesh's winding number, sampled on a grid, passes 0.6; closed, facing
/// outward, without attributes. Empty if the mesh encloses nothing that the grid sees. Work is
/// bounded: the grid has the same number of points for every mesh.
RawMesh winding_shell(const RawMesh& mesh);

}  // namespace sunder
