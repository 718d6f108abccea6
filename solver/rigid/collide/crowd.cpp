#include "solver/rigid/collide/crowd.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "solver/rigid/tolerances.h"

namespace sunder::solver {
void Crowd::thin_out(std::span<ContactChanges> changes, Contacts& contacts, const Bodies& bodies) {
  ByBody<std::uint32_t> crowd;  // number of deep contacts
  for (const ContactChanges& chunk : changes) {
    if (!chunk.deep.empty()) crowd.resize(bodies.size());
    for (const PairSlot i : chunk.deep) {
      ++crowd[contacts.pairs[i].body_a], ++crowd[contacts.pairs[i].body_b];
    }
  }
  if (crowd.empty() || *std::max_element(crowd.begin(), crowd.end()) <= kMaxDeepContacts) return;
  ++times_;
  const auto left_out = [&](const Pair& pair) {
    if (!bodies.dynamic(pair.body_a) || !bodies.dynamic(pair.body_b)) return false;
    const std::uint32_t many = std::min(crowd[pair.body_a], crowd[pair.body_b]);
    return many > kMaxDeepContacts &&
           combine(times_, pair.key()) > ~std::uint64_t{0} / many * kMaxDeepContacts;
  };
  std::vector<PairSlot>& parted = changes.front().parted;
  for (ContactChanges& chunk : changes) {
    for (const auto& [i, manifold] : chunk.touched) contacts.pairs[i].fresh = true;
    std::erase_if(chunk.touched, [&](const auto& t) { return left_out(contacts.pairs[t.first]); });
    if (&chunk != &changes.front())
      parted.insert(parted.end(), chunk.parted.begin(), chunk.parted.end());
    chunk.parted.resize(&chunk == &changes.front() ? parted.size() : 0);
  }
  for (const PairSlot i : contacts.pairs.slots()) {
    Pair& pair = contacts.pairs[i];
    if (!pair.present() || !pair.touching() || !left_out(pair)) continue;
    pair.fresh = true;  // to be tested again
    parted.push_back(i);
  }
  std::sort(parted.begin(), parted.end());
  parted.erase(std::unique(parted.begin(), parted.end()), parted.end());
}

}  // namespace sunder::solver
