// Things joined two by two, and the sets that come of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sunder {

/// Each set is named by its least member, whatever the order of joining (union-find with path
/// halving).
class DisjointSets {
 public:
  /// Members 0 to count − 1, each alone.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// The least member of the set that `member` is in.
  std::uint32_t root(std::uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }

  /// Makes one set of two; whether they were two.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  /// The root of every member.
  std::vector<std::uint32_t> roots() {
    for (std::uint32_t& parent : parent_) parent = root(parent);
    return parent_;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace sunder
