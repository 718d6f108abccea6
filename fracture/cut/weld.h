// Step 3 of a fracture: parts in a cell become one convex where their union is one (paper 3.1).
#pragma once

#include <span>

#include "fracture/cut/intersect.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Returns the one convex that replaces the parts of solids in a cell, whose overlaps are `ghosts`:
/// the cell, or what the outer faces of the parts leave of it. Returns null unless the parts are
/// internal convexes of one material whose union is convex, up to rounding. A face keeps its plane
/// id, its kind and its shading.
ConvexPtr weld(const AlignedPattern& pattern, const AlignedPattern::Cell& cell,
               std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts);

}  // namespace sunder::fracture
