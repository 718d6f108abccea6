// The last tier of repair: a closed isosurface of the winding number of an open mesh.
#pragma once

#include <cstdint>

#include "engine/geometry/raw_mesh.h"

namespace sunder {

/// Returns the isosurface at 0.6 of the mesh's winding number, on a grid with `cells_along` cells
/// along the mesh's longest side: closed, facing outward, without attributes. Empty if no grid
/// point is inside. Where very many triangles overlap, the grid is coarser to bound the work.
RawMesh winding_shell(const RawMesh& mesh, std::uint32_t cells_along);

}  // namespace sunder
