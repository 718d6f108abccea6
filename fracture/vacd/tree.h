// Refines pieces by planes: cuts those with the loosest hulls, and then undoes the cuts that gained
// least, so that the allowed number of convexes is as tight as possible.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fracture/vacd/regions.h"

namespace sunder::fracture {

/// Limits of refine().
struct RefineLimits {
  /// Maximum number of pieces; 0: only pieces with too many polygons are cut.
  std::uint32_t convexes = 0;
  std::uint32_t polygons = 0;  ///< A piece with more polygons is cut again if `convexes` allows it.
  std::function<void(double)> progress{};  ///< Called with the fraction done; may be empty.
};

/// Returns the pieces, some of them cut into smaller ones; never fewer than given.
std::vector<VacdPiece> refine(std::vector<VacdPiece> pieces, const RefineLimits& limits,
                              PlaneIdAllocator& ids);

}  // namespace sunder::fracture
