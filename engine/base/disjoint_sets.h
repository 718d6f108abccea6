// A union-find structure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sunder {

/// Disjoint sets of numbers (union-find with path halving). The root of a set is its least member,
/// whatever the order of joining.
class DisjointSets {
 public:
  /// Makes a set of one member for each of 0 to count − 1.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// Returns the least member of the set that contains `member`.
  std::uint32_t root(std::uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }

  /// Unites the sets of `a` and `b`. Returns true if they were different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  /// Returns the root of each member.
  std::vector<std::uint32_t> roots() {
    for (std::uint32_t& parent : parent_) parent = root(parent);
    return parent_;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace sunder
