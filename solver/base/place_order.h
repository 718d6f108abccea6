// An order in which what is near each other in the world is near each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

/// The cell's number along a curve through space (Morton 1966), which begins again every 1024
/// cells.
std::uint32_t place_key(std::uint32_t x, std::uint32_t y, std::uint32_t z);
/// Sorts `order`, which holds numbers of `keys`, by key; equals stay in their order.
void sort_by_key(std::span<const std::uint32_t> keys, std::vector<std::uint32_t>& order);
/// Sorts numbers of positions by place_key() in cells of 0.25 m, so it begins again every 256 m;
/// equals stay in their order.
void sort_by_place(std::span<const Vec3f> position_W, std::vector<std::uint32_t>& order);

}  // namespace sunder::solver
