#include "fracture/adjacency/islands.h"

#include "engine/base/disjoint_sets.h"

namespace sunder::fracture {

std::vector<std::uint32_t> find_islands(std::size_t count, std::span<const Bond> bonds) {
  // The least member is the root, so the root is numbered first.
  DisjointSets sets(count);
  for (const Bond& bond : bonds) sets.join(bond.a, bond.b);
  std::vector<std::uint32_t> island(count);
  std::uint32_t islands = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    island[i] = sets.root(i) == i ? islands++ : island[sets.root(i)];
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
