// A static bounding-volume hierarchy.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/base/types.h"

namespace sunder {

/// A hierarchy built by a deterministic, binned surface-area heuristic; queries are thread-safe.
class Bvh {
 public:
  Bvh() = default;
  /// Builds the hierarchy; queries return indices of `boxes`.
  explicit Bvh(std::span<const Box> boxes);

  /// Appends the indices of the boxes that overlap `query` to `found`, ascending.
  void overlaps(const Box& query, std::vector<std::uint32_t>& found) const;
  /// Appends the indices of the boxes within `radius_m` of `center`, ascending.
  void within(const Vec3& center, double radius_m, std::vector<std::uint32_t>& found) const;
  bool empty() const { return nodes_.empty(); }

  static auto fields(auto& self) { return std::tie(self.nodes_, self.items_, self.boxes_); }
  /// Returns the number of boxes.
  std::size_t size() const { return items_.size(); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< First item of the subtree.
    std::uint32_t count = 0;  ///< Number of items of a leaf; 0 for an inner node.
    std::uint32_t next = 0;   ///< Index of the node after the subtree.
  };
  void build(std::span<const Box> boxes, std::size_t first, std::size_t count);
  template <class Touches>
  void collect(const Touches& touches, std::vector<std::uint32_t>& found) const;

  std::vector<Node> nodes_;           ///< In depth-first order.
  std::vector<std::uint32_t> items_;  ///< Indices of boxes, in the order of leaves.
  std::vector<Box> boxes_;            ///< The box of each element of items_.
};

}  // namespace sunder
