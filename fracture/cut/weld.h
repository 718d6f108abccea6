// Step 3 of a fracture: the parts that fill a cell become one convex (paper 3.1).
#pragma once

#include <span>

#include "fracture/cut/intersect.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Returns the polyhedron of a cell as the one convex that replaces `parts`, whose overlaps are
/// `ghosts`. Returns null unless the parts are internal convexes of one material that fill the
/// cell, and the whole boundary of the cell was made by this pattern: a face of the old solid in it
/// must keep its texture and plane id.
ConvexPtr weld(const AlignedPattern& pattern, const AlignedPattern::Cell& cell,
               std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts);

}  // namespace sunder::fracture
