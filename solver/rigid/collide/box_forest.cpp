// A tree is merged with added items when these are no longer small against it.
#include "solver/rigid/collide/box_forest.h"

#include <algorithm>

namespace sunder::solver {
namespace {

constexpr std::size_t kGrowth = 8;

}  // namespace

void BoxForest::add(const ByShape<FloatBox>& boxes, std::span<const ShapeSlot> items) {
  if (items.empty()) return;
  std::vector<ShapeSlot> leaves(items.begin(), items.end());
  while (!trees_.empty() && trees_.back().size() < kGrowth * leaves.size()) {
    for (const ShapeSlot item : trees_.back().leaves())
      if (!item.none()) leaves.push_back(item);
    trees_.pop_back();
  }
  BoxTree& tree = trees_.emplace_back();
  tree.build(boxes, leaves);
  place_.resize(std::max(place_.size(), boxes.size()));
  const auto index = static_cast<std::uint32_t>(trees_.size() - 1);
  for (std::uint32_t leaf = 0; leaf < tree.leaves().size(); ++leaf)
    place_[tree.leaves()[leaf]] = {index, leaf};
}

void BoxForest::remove(ShapeSlot item) { trees_[place_[item].tree].remove_leaf(place_[item].leaf); }

}  // namespace sunder::solver
