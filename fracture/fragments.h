// Steps 2 and 3 of a fracture over all convexes that the impact sphere touches.
#pragma once

#include <vector>

#include "fracture/align.h"
#include "fracture/impact_sphere.h"

namespace sunder::fracture {

/// A convex after the cuts, on its way into a piece.
struct Fragment {
  /// The rest: what is outside the impact sphere or the pattern.
  static constexpr std::uint32_t kRest = 0xffffffff;

  ConvexPtr convex;
  std::uint32_t source = 0;  ///< The slot of the convex that it came from.
  std::uint32_t cell = 0;    ///< As in CellPart.
  std::uint32_t group = kRest;
  std::uint8_t anchored = 0;
};

struct Fragments {
  std::vector<Fragment> all;
  std::vector<Ghost> ghosts;  ///< By nodes, as cut_ghosts() says.
  double debris_volume_m3 = 0;
  std::uint32_t welded = 0;
  std::uint32_t failed = 0;
};

/// The sides of `parent` by which it is held that a part of it still reaches.
std::uint8_t inherited_anchors(std::uint8_t anchored, const Box& parent, const Box& part);

/// Cuts the convexes in slots `touched`, welds full cells, and groups by colour what the sphere
/// touches; what overlaps stays together. Convexes that it turns out to leave whole and in place
/// are taken out of `touched`.
Fragments make_fragments(const Structure& structure, std::vector<std::uint32_t>& touched,
                         const AlignedPattern& pattern, const ImpactSphere& sphere,
                         const Fit& fit = {});

}  // namespace sunder::fracture
