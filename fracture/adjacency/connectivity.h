// Connected components after a break, at a cost that does not depend on the size of the structure:
// searches start beside the cut and stop when all but one have ended or met.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sunder::fracture {

/// Result of a search.
struct Separation {
  std::vector<std::vector<std::uint32_t>> islands;  ///< Complete islands, each ascending.
  bool bulk = false;  ///< True if one more island remains, which was not searched completely.
};

/// Calls `visit` with each neighbour of a node.
using Neighbours =
    std::function<void(std::uint32_t node, const std::function<void(std::uint32_t)>& visit)>;

/// Returns the islands that contain `seeds`. Searches advance in turns, one node each, so the cost
/// is about twice that of all islands but the largest.
Separation separate(std::span<const std::uint32_t> seeds, const Neighbours& neighbours);

}  // namespace sunder::fracture
