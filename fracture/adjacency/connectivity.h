// Islands after a break without visiting what did not change: searches start beside the cut, and
// stop as soon as all but one have come to an end or met.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sunder::fracture {

/// What a search found.
struct Separation {
  std::vector<std::vector<std::uint32_t>> islands;  ///< Complete ones, each ascending.
  bool bulk = false;  ///< Whether one more island remains, not searched to its end.
};

/// Calls `visit` with each neighbour of a node.
using Neighbours =
    std::function<void(std::uint32_t node, const std::function<void(std::uint32_t)>& visit)>;

/// The islands that contain the `seeds`. Searches take turns, a node each, so the cost is that of
/// all islands but the largest, twice.
Separation separate(std::span<const std::uint32_t> seeds, const Neighbours& neighbours);

}  // namespace sunder::fracture
