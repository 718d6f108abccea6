#include "fracture/islands.h"

#include <numeric>

namespace sunder::fracture {

std::vector<std::uint32_t> find_islands(std::size_t count, std::span<const Bond> bonds) {
  // Union-find with path halving; the smaller index is the root, so roots come first.
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Bond& bond : bonds) {
    const std::uint32_t a = root(bond.a), b = root(bond.b);
    parent[a > b ? a : b] = a > b ? b : a;
  }
  std::vector<std::uint32_t> island(count);
  std::uint32_t islands = 0;
  for (std::uint32_t i = 0; i < count; ++i) island[i] = root(i) == i ? islands++ : island[root(i)];
  return island;
}

std::vector<std::uint32_t> find_islands(const Compound& compound) {
  if (compound.ghosts.empty()) return find_islands(compound.convexes.size(), compound.bonds);
  std::vector<Bond> links = compound.bonds;
  for (const Ghost& ghost : compound.ghosts) {
    for (const std::uint32_t c : ghost.of) links.push_back({ghost.of[0], c, 0, 0, 0});
  }
  return find_islands(compound.convexes.size(), links);
}

}  // namespace sunder::fracture
