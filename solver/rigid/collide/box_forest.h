// Boxes that stay where they are, but come and go: a few trees whose sizes grow by a factor of
// eight, so that adding costs little more than building a tree of what is added, and removing
// costs a path to a root (Bentley and Saxe 1980, "Decomposable Searching Problems").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/collide/box_tree.h"

namespace sunder::solver {

class BoxForest {
 public:
  /// Adds items that are not in it; `boxes` is by item and must hold those of all items.
  void add(std::span<const FloatBox> boxes, std::span<const std::uint32_t> items);
  /// Takes an item out; others are not in it any more than before.
  void remove(std::uint32_t item);
  /// Calls hit(item) for each item whose box overlaps `query`.
  template <class Hit>
  void overlaps(const FloatBox& query, const Hit& hit) const {
    for (const BoxTree& tree : trees_) tree.overlaps(query, hit);
  }

 private:
  struct Place {
    std::uint32_t tree, leaf;
  };
  std::vector<BoxTree> trees_;  ///< Large ones first.
  std::vector<Place> place_;    ///< By item.
};

}  // namespace sunder::solver
