// An order in which particles that are near each other in the world are near each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

/// Sorts `order`, which holds numbers of `keys`, by key; equals stay in their order.
void sort_by_key(std::span<const std::uint32_t> keys, std::vector<std::uint32_t>& order);
/// Sorts numbers of positions along a curve through space (Morton 1966), in cells of 0.25 m that
/// begin again every 256 m; equals stay in their order.
void sort_by_place(std::span<const Vec3f> position_W, std::vector<std::uint32_t>& order);

}  // namespace sunder::solver
