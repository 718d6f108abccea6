// Step 5 of a fracture: connected components of convexes (paper 3.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// Returns the island of each of `count` convexes joined by `bonds`; islands are numbered in the
/// order of their first convexes.
std::vector<std::uint32_t> find_islands(std::size_t count, std::span<const Bond> bonds);

/// Returns the island of each convex of a compound, joined by bonds and ghosts; numbered as above.
std::vector<std::uint32_t> find_islands(const Compound& compound);

}  // namespace sunder::fracture
