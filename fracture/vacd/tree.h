// Pieces cut further by planes, where hulls are loosest, and put together again where a cut gave
// least: as many convexes as allowed, as tight as the cuts tried can make them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fracture/vacd/regions.h"

namespace sunder::fracture {

/// How far pieces are cut.
struct RefineLimits {
  std::uint32_t convexes = 0;  ///< At most so many pieces; 0: cut only what has too many polygons.
  std::uint32_t polygons = 0;  ///< A piece with more is cut again, if `convexes` allows.
  std::function<void(double)> progress{};  ///< Told of the share done; may be empty.
};

/// The pieces, some of them cut into smaller ones; never fewer than before.
std::vector<VacdPiece> refine(std::vector<VacdPiece> pieces, const RefineLimits& limits,
                              PlaneNames& names);

}  // namespace sunder::fracture
