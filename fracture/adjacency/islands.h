// Step 5 of a fracture: convexes that no longer touch part company (paper 3.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// The island of each of `count` convexes joined by `bonds`: islands are numbered in the order of
/// their first convex.
std::vector<std::uint32_t> find_islands(std::size_t count, std::span<const Bond> bonds);

/// The same for a compound, whose convexes hold together where they overlap too.
std::vector<std::uint32_t> find_islands(const Compound& compound);

}  // namespace sunder::fracture
