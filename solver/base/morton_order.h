// Spatial sorting along a Morton curve, so that neighbours in space are close in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

/// Returns the Morton code (Morton 1966) of a cell; it repeats every 1024 cells along each axis.
std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z);
/// Sorts `order`, which holds indices into `keys`, by key; stable.
void sort_by_key(std::span<const std::uint32_t> keys, std::vector<std::uint32_t>& order);
/// Sorts `order`, which holds indices into `position_W`, by the morton_code() of their cells of
/// 0.25 m, which repeats every 256 m; stable.
void sort_by_morton_code(std::span<const Vec3f> position_W, std::vector<std::uint32_t>& order);

}  // namespace sunder::solver
