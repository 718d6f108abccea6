// Fragments: the convexes after the cuts, before islands are known.
#pragma once

#include <cstdint>

#include "engine/model/structure.h"

namespace sunder::fracture {

/// A convex after the cuts.
struct Fragment {
  /// Group of the fragments outside the impact sphere or the pattern.
  static constexpr std::uint32_t kRest = 0xffffffff;

  ConvexPtr convex;
  ConvexSlot source;       ///< Slot of the convex that it was cut from.
  std::uint32_t cell = 0;  ///< Cell, as in CellPart.
  std::uint32_t group = kRest;
  std::uint8_t anchored = 0;
};

}  // namespace sunder::fracture
