// What the cuts leave of the convexes, before it is known what holds together.
#pragma once

#include <cstdint>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// A convex after the cuts, on its way into a piece.
struct Fragment {
  /// The rest: what is outside the impact sphere or the pattern.
  static constexpr std::uint32_t kRest = 0xffffffff;

  ConvexPtr convex;
  ConvexSlot source;       ///< Of the convex that it came from.
  std::uint32_t cell = 0;  ///< As in CellPart.
  std::uint32_t group = kRest;
  std::uint8_t anchored = 0;
};

}  // namespace sunder::fracture
