// Ghosts in a fracture: cells cut them as they cut their convexes (paper 4.3).
#pragma once

#include <vector>

#include "engine/model/structure.h"
#include "fracture/cut/fragment.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Cuts the ghosts of the convexes in slots `touched`, whose parts are `fragments` (those of a slot
/// in a row). Returned ghosts name nodes: slots for untouched convexes, and slot_count() + i for
/// fragment i. If a sliver of a convex was merged into another cell, its overlaps go with it and
/// name only the fragment that has it, so that volumes add up and none is negative. Adds the volume
/// of what is too small to `debris_volume_m3`.
std::vector<Ghost> cut_ghosts(const Structure& structure, const std::vector<ConvexSlot>& touched,
                              const AlignedPattern& pattern, const std::vector<Fragment>& fragments,
                              double& debris_volume_m3);

/// Gives fragments that overlap the first of their groups, or the rest if one of them overlaps a
/// convex that was not cut.
void group_overlaps(const std::vector<Ghost>& ghosts, std::uint32_t slot_count,
                    std::vector<Fragment>& fragments);

}  // namespace sunder::fracture
