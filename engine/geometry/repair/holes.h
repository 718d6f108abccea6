// The third tier of repair: closing what is open.
#pragma once

#include <cstddef>

#include "engine/geometry/repair/surface.h"

namespace sunder {

/// How many loops of open edges were closed, and how.
struct ClosedHoles {
  std::size_t planar = 0;  ///< Closed by one polygon, or by triangles where it crosses itself.
  std::size_t curved = 0;  ///< Closed by triangles of least area.
  std::size_t left = 0;    ///< Too long, or too large for the patch around them.
};

/// Appends polygons that close the loops of open edges of a surface whose vertices are split.
/// Pair the edges of `surface.mesh` again afterwards.
ClosedHoles close_holes(Surface& surface);

}  // namespace sunder
