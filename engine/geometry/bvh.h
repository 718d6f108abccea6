// A bounding-volume hierarchy over boxes that do not move.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// Built once (binned surface-area heuristic, deterministic), queried often, from any thread.
class Bvh {
 public:
  Bvh() = default;
  /// Over boxes, named by their place.
  explicit Bvh(std::span<const Box> boxes);

  /// Appends the indices of the boxes overlapping `query` to `found`, ascending.
  void overlaps(const Box& query, std::vector<std::uint32_t>& found) const;
  /// Appends the indices of the boxes that come within `radius_m` of `center`, ascending.
  void within(const Vec3& center, double radius_m, std::vector<std::uint32_t>& found) const;
  bool empty() const { return nodes_.empty(); }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< Of the items below it.
    std::uint32_t count = 0;  ///< Items of a leaf; 0 for an inner node.
    std::uint32_t next = 0;   ///< The node after the subtree.
  };
  void build(std::span<const Box> boxes, std::size_t first, std::size_t count);
  template <class Touches>
  void collect(const Touches& touches, std::vector<std::uint32_t>& found) const;

  std::vector<Node> nodes_;  ///< Depth first.
  std::vector<std::uint32_t> items_;
  std::vector<Box> boxes_;  ///< Of items_.
};

}  // namespace sunder
