// The part of a convex that lies in one cell of a pattern.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// The part of a convex that lies in one cell of a pattern.
struct CellPart {
  static constexpr std::uint32_t kFarCell = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t cell = kFarCell;  ///< Index in AlignedPattern::cells; kFarCell outside the box.
  ConvexPtr convex;               ///< The original object if nothing was cut off.
};

}  // namespace sunder::fracture
