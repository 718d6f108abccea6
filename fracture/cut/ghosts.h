// Ghosts in a fracture: they are cut by the cells as their convexes are (paper 4.3).
#pragma once

#include <vector>

#include "engine/model/structure.h"
#include "fracture/cut/fragment.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Cuts the ghosts of the convexes in slots `touched`, whose parts are `fragments` (all those of a
/// slot in a row). The ghosts that come out name nodes: slots where a convex is not touched, and
/// slot_count() + i for fragment i. Where the sliver of a convex went to another cell, its overlaps
/// go with it and name it alone, so that volumes add up and none is negative. Adds what is too
/// small to `debris_volume_m3`.
std::vector<Ghost> cut_ghosts(const Structure& structure, const std::vector<ConvexSlot>& touched,
                              const AlignedPattern& pattern, const std::vector<Fragment>& fragments,
                              double& debris_volume_m3);

/// Lets fragments that overlap go the same way: all with the first of their groups, or, where one
/// of them overlaps a convex that was not cut, all with the rest.
void hold_overlaps(const std::vector<Ghost>& ghosts, std::uint32_t slot_count,
                   std::vector<Fragment>& fragments);

}  // namespace sunder::fracture
