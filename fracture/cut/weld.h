// Step 3 of a fracture: a cell that is fully covered becomes one convex (paper 3.1).
#pragma once

#include <span>

#include "fracture/cut/intersect.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// The one convex that `parts` of a cell amount to: exactly the cell's polyhedron; `ghosts` are the
/// overlaps of those parts. Null unless they are internal convexes of one material that fill the
/// cell, and its whole boundary was made by this pattern (a face of the old solid that lies in it
/// keeps its look and name, so it is left alone).
ConvexPtr weld(const AlignedPattern& pattern, const AlignedPattern::Cell& cell,
               std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts);

}  // namespace sunder::fracture
