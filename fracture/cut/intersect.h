// Step 2 of a fracture: a convex is clipped by the cells it reaches into (paper 3.1).
#pragma once

#include <vector>

#include "fracture/cut/cell_part.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// A convex cut by a pattern: several parts a cell where its visual mesh is in several there. The
/// parts' volumes and the debris sum to the convex's volume.
struct Intersection {
  std::vector<CellPart> parts;
  double debris_volume_m3 = 0;  ///< Parts below the floor that no neighbour could take.
  bool failed = false;          ///< The volumes did not add up, so the convex was left whole.
};

/// Cuts `convex` by all cells; what it owns of a visual mesh is cut with it, and new convexes are
/// fitted to that. Depends on nothing but its arguments; any thread may call it.
Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex, const Fit& fit = {});

}  // namespace sunder::fracture
