// The third tier of repair: closes holes.
#pragma once

#include <cstddef>

#include "engine/geometry/repair/surface.h"

namespace sunder {

/// Numbers of loops of open edges, by how they were closed.
struct ClosedHoles {
  std::size_t planar = 0;  ///< Closed by one polygon, or by triangles if the loop crosses itself.
  std::size_t curved = 0;  ///< Closed by triangles, of least area if the loop is short.
};

/// Appends polygons that close the loops of open edges. The vertices of the surface must have been
/// split (split_vertices()), and the edges of `surface.mesh` must be paired again afterwards.
ClosedHoles close_holes(Surface& surface);

}  // namespace sunder
