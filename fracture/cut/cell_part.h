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

/// Least volume of a part, relative to its convex and to the cube of the pattern's unit. Smaller
/// parts stay with a neighbour: the cut that would separate them is not made.
inline constexpr double kMinPartVolume = 1e-6;

}  // namespace sunder::fracture
