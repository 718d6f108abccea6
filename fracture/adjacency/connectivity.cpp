#include "fracture/adjacency/connectivity.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace sunder::fracture {
namespace {

/// Searches that become one where they meet.
class Searches {
 public:
  Searches(std::span<const std::uint32_t> seeds, const Neighbours& neighbours)
      : neighbours_(neighbours),
        found_(seeds.size()),
        next_(seeds.size(), 0),
        merged_(seeds.size()) {
    std::iota(merged_.begin(), merged_.end(), 0u);
    for (std::uint32_t s = 0; s < seeds.size(); ++s) reach(seeds[s], s);
  }

  Separation run() {
    std::vector<std::uint32_t> open;
    for (std::uint32_t s = 0; s < merged_.size(); ++s) {
      if (merged_[s] == s && !found_[s].empty()) open.push_back(s);
    }
    Separation result;
    while (open.size() > 1) {
      for (const std::uint32_t s : open) {
        if (merged_[s] == s) expand(s);
      }
      std::erase_if(open, [&](std::uint32_t s) {
        if (merged_[s] != s) return true;
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
  std::uint32_t root(std::uint32_t s) {
    while (merged_[s] != s) s = merged_[s] = merged_[merged_[s]];
    return s;
  }

  void expand(std::uint32_t s) {
    if (next_[s] == found_[s].size()) return;
    neighbours_(found_[s][next_[s]++], [&](std::uint32_t node) { reach(node, root(s)); });
  }

  /// Search `s` comes to a node: a new one, or another search's, which it then is one with.
  void reach(std::uint32_t node, std::uint32_t s) {
    const auto [it, is_new] = owner_.emplace(node, s);
    if (is_new) {
      found_[s].push_back(node);
      return;
    }
    const std::uint32_t other = root(it->second);
    if (other == s) return;
    const std::uint32_t into = std::min(s, other), from = std::max(s, other);
    // What was expanded stays in front of what was not.
    const auto front = found_[into].begin() + static_cast<std::ptrdiff_t>(next_[into]);
    found_[into].insert(front, found_[from].begin(), found_[from].end());
    next_[into] += next_[from];
    found_[from].clear();
    next_[from] = 0;
    merged_[from] = into;
  }

  const Neighbours& neighbours_;
  std::vector<std::vector<std::uint32_t>> found_;  ///< Per search; the first next_ are expanded.
  std::vector<std::size_t> next_;
  std::vector<std::uint32_t> merged_;
  std::unordered_map<std::uint32_t, std::uint32_t> owner_;
};

}  // namespace

Separation separate(std::span<const std::uint32_t> seeds, const Neighbours& neighbours) {
  return Searches(seeds, neighbours).run();
}

}  // namespace sunder::fracture
