// Steps 2 and 3 of a fracture over all convexes that the impact sphere touches.
#pragma once

#include <vector>

#include "fracture/cut/fragment.h"
#include "fracture/cut/impact_sphere.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// What steps 2 and 3 leave.
struct Fragments {
  std::vector<Fragment> all;
  std::vector<Ghost> ghosts;  ///< By nodes, as cut_ghosts() says.
  double debris_volume_m3 = 0;
  std::uint32_t welded = 0;
  std::uint32_t failed = 0;
  double failed_m3 = 0;
};

/// Cuts the convexes in slots `touched`, welds full cells, and groups by colour what the sphere
/// touches; what overlaps stays together. Convexes that it turns out to leave whole and in place
/// are taken out of `touched`.
Fragments make_fragments(const Structure& structure, std::vector<ConvexSlot>& touched,
                         const AlignedPattern& pattern, const ImpactSphere& sphere,
                         const Fit& fit = {});

}  // namespace sunder::fracture
