#include "solver/rigid/collide/crowd.h"

#include <algorithm>

#include "engine/base/hash.h"

namespace sunder::solver {
namespace {

// Deep contacts of a body that are solved, about; of more, a share.
constexpr std::uint64_t kMostDeep = 24;

}  // namespace

void Crowd::thin_out(std::span<ContactChanges> changes, Contacts& contacts, const Bodies& bodies) {
  std::vector<std::uint32_t> crowd;  // deep contacts, by body slot
  for (const ContactChanges& chunk : changes) {
    if (!chunk.deep.empty()) crowd.resize(bodies.size());
    for (const std::uint32_t i : chunk.deep) {
      ++crowd[contacts.pairs[i].body_a], ++crowd[contacts.pairs[i].body_b];
    }
  }
  if (crowd.empty() || *std::max_element(crowd.begin(), crowd.end()) <= kMostDeep) return;
  ++times_;
  const auto left_out = [&](const Pair& pair) {
    if (!bodies.dynamic(pair.body_a) || !bodies.dynamic(pair.body_b)) return false;
    const std::uint32_t many = std::min(crowd[pair.body_a], crowd[pair.body_b]);
    return many > kMostDeep && combine(times_, pair.key()) > ~std::uint64_t{0} / many * kMostDeep;
  };
  std::vector<std::uint32_t>& parted = changes.front().parted;
  for (ContactChanges& chunk : changes) {
    for (const auto& [i, manifold] : chunk.touched) contacts.pairs[i].fresh = true;
    std::erase_if(chunk.touched, [&](const auto& t) { return left_out(contacts.pairs[t.first]); });
    if (&chunk != &changes.front())
      parted.insert(parted.end(), chunk.parted.begin(), chunk.parted.end());
    chunk.parted.resize(&chunk == &changes.front() ? parted.size() : 0);
  }
  for (std::uint32_t i = 0; i < contacts.pairs.size(); ++i) {
    Pair& pair = contacts.pairs[i];
    if (!pair.present() || !pair.touching() || !left_out(pair)) continue;
    pair.fresh = true;  // to be looked at again
    parted.push_back(i);
  }
  std::sort(parted.begin(), parted.end());
  parted.erase(std::unique(parted.begin(), parted.end()), parted.end());
}

}  // namespace sunder::solver
