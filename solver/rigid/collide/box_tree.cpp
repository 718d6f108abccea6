// Building and refitting of the implicit tree.
#include "solver/rigid/collide/box_tree.h"

#include <algorithm>
#include <numeric>

#include "engine/base/parallel.h"
#include "solver/base/morton_order.h"

namespace sunder::solver {
void BoxTree::build(const ByShape<FloatBox>& boxes, std::span<const ShapeSlot> items) {
  FloatBox all;
  for (const ShapeSlot item : items) {
    const Vec3f center = 0.5f * (boxes[item].min + boxes[item].max);
    all.min = all.min.cwiseMin(center);
    all.max = all.max.cwiseMax(center);
  }
  const float extent = std::max(1e-6f, items.empty() ? 0.f : (all.max - all.min).maxCoeff());
  const float scale = 1023.f / extent;
  std::vector<std::uint32_t> keys(items.size()), order(items.size());
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const FloatBox& box = boxes[items[i]];
    const Vec3f at = (0.5f * (box.min + box.max) - all.min) * scale;
    auto cell = [&](int k) { return static_cast<std::uint32_t>(at[k]); };
    keys[i] = morton_code(cell(0), cell(1), cell(2));
  }
  sort_by_key(keys, order);
  items_.resize(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) items_[i] = items[order[i]];

  levels_.clear();
  std::uint32_t count = static_cast<std::uint32_t>(items_.size());
  do {
    count = lane_groups(count);
    levels_.emplace_back(count);
  } while (count > 1);
  refit(boxes);
}

const char* BoxTree::wrong_field() const {
  const FloatBox none;
  std::size_t count = items_.size();
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    if (levels_[level].size() != lane_groups(static_cast<std::uint32_t>(count))) return "levels_";
    for (std::size_t i = 0; i < levels_[level].size() * kLanes; ++i) {
      const FloatBox box = levels_[level][i / kLanes].get(i % kLanes);
      if (!box.min.allFinite() || !box.max.allFinite()) return "levels_";
      // Leaves that are not there have a box that nothing meets.
      const bool is_there = i < count && (level > 0 || !items_[i].none());
      if (!is_there && (box.min != none.min || box.max != none.max)) return "levels_";
    }
    count = levels_[level].size();
  }
  return items_.empty() || (!levels_.empty() && count == 1) ? nullptr : "levels_";
}

void BoxTree::refit(const ByShape<FloatBox>& boxes) {
  if (items_.empty()) return;
  for_chunks(levels_[0].size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin * kLanes; i < end * kLanes; ++i)
      levels_[0][i / kLanes].set(i % kLanes, i < items_.size() ? boxes[items_[i]] : FloatBox());
  });
  fit_inner_levels();
}

void BoxTree::fit_inner_levels() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const std::vector<Chunk>& below = levels_[level - 1];
    for (std::size_t i = 0; i < levels_[level].size() * kLanes; ++i)
      levels_[level][i / kLanes].set(i % kLanes, i < below.size() ? below[i].bounds() : FloatBox());
  }
}

void BoxTree::remove_leaf(std::uint32_t leaf) {
  items_[leaf] = {};
  FloatBox box;
  for (std::vector<Chunk>& level : levels_) {
    Chunk& chunk = level[leaf / kLanes];
    chunk.set(leaf % kLanes, box);
    box = chunk.bounds();
    leaf /= kLanes;
  }
}

void BoxTree::Chunk::set(std::size_t lane, const FloatBox& box) {
  min.x[lane] = box.min.x(), max.x[lane] = box.max.x();
  min.y[lane] = box.min.y(), max.y[lane] = box.max.y();
  min.z[lane] = box.min.z(), max.z[lane] = box.max.z();
}

FloatBox BoxTree::Chunk::bounds() const {
  return {{min_lane(min.x), min_lane(min.y), min_lane(min.z)},
          {max_lane(max.x), max_lane(max.y), max_lane(max.z)}};
}

}  // namespace sunder::solver
