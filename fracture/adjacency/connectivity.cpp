#include "fracture/adjacency/connectivity.h"

#include <algorithm>
#include <unordered_map>

#include "engine/base/disjoint_sets.h"

namespace sunder::fracture {
namespace {

/// Simultaneous breadth-first searches, which merge where they meet.
class Searches {
 public:
  Searches(std::span<const std::uint32_t> seeds, const Neighbours& neighbours)
      : neighbours_(neighbours),
        found_(seeds.size()),
        next_(seeds.size(), 0),
        merged_(seeds.size()) {
    for (std::uint32_t s = 0; s < seeds.size(); ++s) reach(seeds[s], s);
  }

  Separation run() {
    std::vector<std::uint32_t> open;
    for (std::uint32_t s = 0; s < found_.size(); ++s) {
      if (merged_.root(s) == s && !found_[s].empty()) open.push_back(s);
    }
    Separation result;
    while (open.size() > 1) {
      for (const std::uint32_t s : open) {
        if (merged_.root(s) == s) expand(s);
      }
      std::erase_if(open, [&](std::uint32_t s) {
        if (merged_.root(s) != s) return true;
        if (next_[s] < found_[s].size()) return false;
        std::sort(found_[s].begin(), found_[s].end());
        result.islands.push_back(std::move(found_[s]));
        return true;
      });
    }
    result.bulk = !open.empty();
    return result;
  }

 private:
  void expand(std::uint32_t s) {
    if (next_[s] == found_[s].size()) return;
    neighbours_(found_[s][next_[s]++], [&](std::uint32_t node) { reach(node, merged_.root(s)); });
  }

  /// Search `s` reaches a node; if another search owns it, the two searches merge.
  void reach(std::uint32_t node, std::uint32_t s) {
    const auto [it, is_new] = owner_.emplace(node, s);
    if (is_new) {
      found_[s].push_back(node);
      return;
    }
    const std::uint32_t other = merged_.root(it->second);
    if (other == s) return;
    const std::uint32_t into = std::min(s, other), from = std::max(s, other);
    // Expanded nodes stay before the others.
    const auto front = found_[into].begin() + static_cast<std::ptrdiff_t>(next_[into]);
    found_[into].insert(front, found_[from].begin(), found_[from].end());
    next_[into] += next_[from];
    found_[from].clear();
    next_[from] = 0;
    merged_.join(into, from);
  }

  const Neighbours& neighbours_;
  std::vector<std::vector<std::uint32_t>> found_;  ///< Per search; the first next_ are expanded.
  std::vector<std::size_t> next_;
  DisjointSets merged_;  ///< Merged searches; the least number represents them.
  std::unordered_map<std::uint32_t, std::uint32_t> owner_;
};

}  // namespace

Separation separate(std::span<const std::uint32_t> seeds, const Neighbours& neighbours) {
  return Searches(seeds, neighbours).run();
}

}  // namespace sunder::fracture
