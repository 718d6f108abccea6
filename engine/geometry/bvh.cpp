// A node is split across the longest axis of the boxes' centres, at the cheapest of the planes
// between kBins bins, or in half if all centres coincide. Nodes are stored in depth-first order
// with the end of their subtree, so a query is a loop without a stack.
#include "engine/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/base/state_checks.h"
#include "engine/geometry/box_distance.h"

namespace sunder {
namespace {

constexpr std::size_t kBins = 12;
constexpr std::size_t kMaxLeafItems = 4;

double half_area(const Box& box) {
  if (box.empty()) return 0;
  const Vec3 e = box.extent();
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

/// Bins of equal width along the longest axis of the boxes' centres.
struct Bins {
  int axis = 0;
  double start = 0, scale = 0;

  Bins(const Box& centers) {
    const Vec3 extent = centers.extent();
    extent.maxCoeff(&axis);
    start = centers.min[axis];
    scale = extent[axis] > 0 ? static_cast<double>(kBins) / extent[axis] : 0;
  }
  std::size_t bin_of(const Box& box) const {
    const double bin = (box.center()[axis] - start) * scale;
    return std::min(kBins - 1, static_cast<std::size_t>(std::max(bin, 0.0)));
  }
};

/// Returns the first bin of the right half of the cheapest split; 0 if all centres are in one bin.
std::size_t cheapest_split(std::span<const Box> boxes, std::span<const std::uint32_t> items,
                           const Bins& bins) {
  std::array<Box, kBins> box;
  std::array<std::size_t, kBins> count{};
  for (const std::uint32_t item : items) {
    const std::size_t bin = bins.bin_of(boxes[item]);
    box[bin].extend(boxes[item]);
    ++count[bin];
  }
  std::array<double, kBins> left_cost{};  // cost of the bins below each bin
  Box left;
  std::size_t left_count = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    left_cost[b] = half_area(left) * static_cast<double>(left_count);
    left.extend(box[b]);
    left_count += count[b];
  }
  std::size_t best = 0, right_count = 0;
  double best_cost = 0;
  Box right;
  for (std::size_t b = kBins - 1; b > 0; --b) {
    right.extend(box[b]);
    right_count += count[b];
    if (right_count == 0 || right_count == items.size()) continue;
    const double cost = left_cost[b] + half_area(right) * static_cast<double>(right_count);
    if (best == 0 || cost < best_cost) {
      best = b;
      best_cost = cost;
    }
  }
  return best;
}

/// Reorders `items` into two non-empty parts and returns the size of the first.
std::size_t split(std::span<const Box> boxes, std::span<std::uint32_t> items) {
  Box centers;
  for (const std::uint32_t item : items) centers.extend(boxes[item].center());
  const Bins bins(centers);
  const std::size_t bin = cheapest_split(boxes, items, bins);
  if (bin == 0) return items.size() / 2;
  const auto middle = std::stable_partition(items.begin(), items.end(), [&](std::uint32_t item) {
    return bins.bin_of(boxes[item]) < bin;
  });
  return static_cast<std::size_t>(middle - items.begin());
}

}  // namespace

Bvh::Bvh(std::span<const Box> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(boxes.size());
  if (!boxes.empty()) build(boxes, 0, boxes.size());
  boxes_.reserve(boxes.size());
  for (const std::uint32_t item : items_) boxes_.push_back(boxes[item]);
}

const char* Bvh::wrong_field() const {
  if (!are_different_below(items_, items_.size())) return "items_";
  if (boxes_.size() != items_.size()) return "boxes_";
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (node.next <= n || node.next > nodes_.size() || node.first > items_.size() ||
        node.count > items_.size() - node.first)
      return "nodes_";
  }
  return nullptr;
}

void Bvh::build(std::span<const Box> boxes, std::size_t first, std::size_t count) {
  const std::size_t index = nodes_.size();
  const auto items = std::span(items_).subspan(first, count);
  Node node{.box = {}, .first = static_cast<std::uint32_t>(first), .count = 0, .next = 0};
  for (const std::uint32_t item : items) node.box.extend(boxes[item]);
  if (count <= kMaxLeafItems) node.count = static_cast<std::uint32_t>(count);
  nodes_.push_back(node);
  if (count > kMaxLeafItems) {
    const std::size_t left = split(boxes, items);
    build(boxes, first, left);
    build(boxes, first + left, count - left);
  }
  nodes_[index].next = static_cast<std::uint32_t>(nodes_.size());
}

template <class Touches>
void Bvh::collect(const Touches& touches, std::vector<std::uint32_t>& found) const {
  const auto before = static_cast<std::ptrdiff_t>(found.size());
  for (std::size_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    if (!touches(node.box)) {
      n = node.next;
      continue;
    }
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      if (touches(boxes_[i])) found.push_back(items_[i]);
    }
    ++n;
  }
  std::sort(found.begin() + before, found.end());
}

void Bvh::overlaps(const Box& query, std::vector<std::uint32_t>& found) const {
  collect([&](const Box& box) { return box.overlaps(query); }, found);
}

void Bvh::within(const Vec3& center, double radius_m, std::vector<std::uint32_t>& found) const {
  const double reach = radius_m * radius_m;
  collect([&](const Box& box) { return squared_distance(box, center) <= reach; }, found);
}

}  // namespace sunder
