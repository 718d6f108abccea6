// The last tier of repair: a new, closed surface around whatever a mesh seems to enclose.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// The surface where the mesh's winding number passes 0.6, on a grid with `cells_along` cells along
/// the mesh's longest side; closed, facing outward, without attributes. Empty if the mesh encloses
/// nothing that the grid sees. The grid is coarser where so many triangles overlap that it would
/// take seconds.
RawMesh winding_shell(const RawMesh& mesh, std::uint32_t cells_along);

}  // namespace sunder
