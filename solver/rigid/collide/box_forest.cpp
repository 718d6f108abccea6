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

const char* BoxForest::wrong_field() const {
  for (std::uint32_t tree = 0; tree < trees_.size(); ++tree) {
    const std::span<const ShapeSlot> leaves = trees_[tree].leaves();
    for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
      const ShapeSlot item = leaves[leaf];
      if (item.none()) continue;
      if (item.value >= place_.size() || place_[item].tree != tree || place_[item].leaf != leaf)
        return "place_";
    }
  }
  return nullptr;
}

bool BoxForest::contains(ShapeSlot item) const {
  if (item.value >= place_.size() || place_[item].tree >= trees_.size()) return false;
  const std::span<const ShapeSlot> leaves = trees_[place_[item].tree].leaves();
  return place_[item].leaf < leaves.size() && leaves[place_[item].leaf] == item;
}

std::size_t BoxForest::size() const {
  std::size_t items = 0;
  for (const BoxTree& tree : trees_)
    for (const ShapeSlot item : tree.leaves()) items += !item.none();
  return items;
}

void BoxForest::remove(ShapeSlot item) { trees_[place_[item].tree].remove_leaf(place_[item].leaf); }

}  // namespace sunder::solver
