// Step 2 of a fracture: a convex is clipped by the cells it reaches into (paper 3.1).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/world/compound.h"
#include "fracture/align.h"

namespace sunder::fracture {

/// What one cell gets of one convex.
struct CellPart {
  static constexpr std::uint32_t kFarCell = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t cell = kFarCell;  ///< Index in AlignedPattern::cells; kFarCell outside the box.
  ConvexPtr convex;               ///< The very convex given, where nothing was cut off.
};

/// A convex cut by a pattern: several parts a cell where its visual mesh is in several there. The
/// parts' volumes and the debris sum to the convex's volume.
struct Intersection {
  std::vector<CellPart> parts;
  double debris_volume_m3 = 0;  ///< Parts below the floor that no neighbour could take.
  bool failed = false;          ///< The volumes did not add up, so the convex was left whole.
};

/// Parts smaller than this share of their convex, or of the cube of the pattern's unit, stay with a
/// neighbour: the cut that would leave them is not made.
inline constexpr double kVolumeFloor = 1e-6;

/// Cuts `convex` by all cells; what it owns of a visual mesh is cut with it, and new convexes are
/// fitted to that. Depends on nothing but its arguments; any thread may call it.
Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex, const Fit& fit = {});

}  // namespace sunder::fracture
