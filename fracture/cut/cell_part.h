// What one cell of a pattern gets of one convex.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// What one cell gets of one convex.
struct CellPart {
  static constexpr std::uint32_t kFarCell = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t cell = kFarCell;  ///< Index in AlignedPattern::cells; kFarCell outside the box.
  ConvexPtr convex;               ///< The very convex given, where nothing was cut off.
};

/// Parts smaller than this share of their convex, or of the cube of the pattern's unit, stay with a
/// neighbour: the cut that would leave them is not made.
inline constexpr double kVolumeFloor = 1e-6;

}  // namespace sunder::fracture
