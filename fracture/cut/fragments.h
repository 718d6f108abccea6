// Steps 2 and 3 of a fracture for all convexes that the impact sphere touches.
#pragma once

#include <vector>

#include "fracture/cut/fragment.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// Result of steps 2 and 3.
struct Fragments {
  std::vector<Fragment> all;
  std::vector<Ghost> ghosts;  ///< By nodes; see cut_ghosts().
  double debris_volume_m3 = 0;
  std::uint32_t welded = 0;
  std::uint32_t failed = 0;
  double failed_m3 = 0;
};

/// Cuts the convexes in slots `touched`, welds full cells, and groups fragments within the sphere
/// by colour; fragments that overlap get one group. Removes slots from `touched` whose convexes
/// turn out to stay whole and in the rest.
Fragments make_fragments(const Structure& structure, std::vector<ConvexSlot>& touched,
                         const AlignedPattern& pattern, const ImpactSphere& sphere,
                         const Fit& fit = {});

}  // namespace sunder::fracture
