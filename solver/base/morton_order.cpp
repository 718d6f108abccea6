#include "solver/base/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

constexpr float kCellsPerMetre = 4;
constexpr int kBitsPerPass = 11;
constexpr std::size_t kKeysPerChunk = 4096;

/// Spreads the lowest ten bits so that two zero bits lie between neighbours.
std::uint32_t spread(std::uint32_t bits) {
  bits &= 0x3ff;
  bits = (bits | bits << 16) & 0x030000ff;
  bits = (bits | bits << 8) & 0x0300f00f;
  bits = (bits | bits << 4) & 0x030c30c3;
  return (bits | bits << 2) & 0x09249249;
}

std::uint32_t place_of(const Vec3f& position_W) {
  const auto cell = [](float x) {
    const float most = 1e9f;  // limit within which the cast is defined
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::min(std::max(std::floor(kCellsPerMetre * x), -most), most)));
  };
  return morton_code(cell(position_W.x()), cell(position_W.y()), cell(position_W.z()));
}

}  // namespace

std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

void sort_by_key(std::span<const std::uint32_t> keys, std::vector<std::uint32_t>& order) {
  struct Item {
    std::uint32_t key, index;
  };
  std::vector<Item> items(order.size()), sorted(order.size());
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    items[i] = {keys[order[i]], order[i]};
    bits |= items[i].key;
  }
  for (int done = 0; done < 32 && bits >> done != 0; done += kBitsPerPass) {
    const auto digit = [&](const Item& item) {
      return item.key >> done & ((1u << kBitsPerPass) - 1);
    };
    std::array<std::uint32_t, (1u << kBitsPerPass) + 1> first{};
    for (const Item& item : items) ++first[digit(item) + 1];
    for (std::size_t d = 1; d < first.size(); ++d) first[d] += first[d - 1];
    for (const Item& item : items) sorted[first[digit(item)]++] = item;
    std::swap(items, sorted);
  }
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].index;
}

void sort_by_morton_code(std::span<const Vec3f> position_W, std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> places(position_W.size());
  for_chunks(places.size(), kKeysPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) places[i] = place_of(position_W[i]);
  });
  sort_by_key(places, order);
}

}  // namespace sunder::solver
