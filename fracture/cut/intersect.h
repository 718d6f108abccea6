// Step 2 of a fracture: a convex is cut by the cells that it reaches into (paper 3.1).
#pragma once

#include <vector>

#include "fracture/cut/cell_part.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// A convex cut by a pattern; a cell has several parts if the visual mesh in it has several
/// islands. The volumes of parts and debris sum to the volume of the convex.
struct Intersection {
  std::vector<CellPart> parts;
  /// Volume of parts below the least volume that no neighbour could take.
  double debris_volume_m3 = 0;
  bool failed = false;  ///< The volumes did not add up, so the convex was left whole.
};

/// Cuts `convex` and its visual mesh by all cells, and fits new convexes to the mesh. A pure
/// function; may be called from any thread.
Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex, const Fit& fit = {});

}  // namespace sunder::fracture
