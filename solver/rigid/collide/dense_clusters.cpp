#include "solver/rigid/collide/dense_clusters.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
bool DenseClusters::drop_contacts(std::span<ContactChanges> changes, Contacts& contacts,
                                  const Bodies& bodies) {
  ByBody<std::uint32_t> deep_contacts;
  for (const ContactChanges& chunk : changes) {
    if (!chunk.deep.empty()) deep_contacts.resize(bodies.size());
    for (const PairSlot i : chunk.deep) {
      ++deep_contacts[contacts.pairs[i].body_a], ++deep_contacts[contacts.pairs[i].body_b];
    }
  }
  if (deep_contacts.empty() ||
      *std::max_element(deep_contacts.begin(), deep_contacts.end()) <= kMaxDeepContacts)
    return false;
  ++times_;
  bool dropped = false;
  const auto left_out = [&](const Pair& pair) {
    if (!bodies.dynamic(pair.body_a) || !bodies.dynamic(pair.body_b)) return false;
    const std::uint32_t many = std::min(deep_contacts[pair.body_a], deep_contacts[pair.body_b]);
    return many > kMaxDeepContacts &&
           combine(times_, pair.key()) > ~std::uint64_t{0} / many * kMaxDeepContacts;
  };
  std::vector<PairSlot>& separated = changes.front().separated;
  for (ContactChanges& chunk : changes) {
    for (const auto& [i, manifold] : chunk.touched) contacts.pairs[i].needs_test = true;
    dropped |= std::erase_if(chunk.touched,
                             [&](const auto& t) { return left_out(contacts.pairs[t.first]); }) > 0;
    if (&chunk != &changes.front())
      separated.insert(separated.end(), chunk.separated.begin(), chunk.separated.end());
    chunk.separated.resize(&chunk == &changes.front() ? separated.size() : 0);
  }
  for (const PairSlot i : contacts.pairs.slots()) {
    Pair& pair = contacts.pairs[i];
    if (!pair.present() || !pair.touching() || !left_out(pair)) continue;
    pair.needs_test = true;  // to be tested again
    separated.push_back(i);
    dropped = true;
  }
  std::sort(separated.begin(), separated.end());
  separated.erase(std::unique(separated.begin(), separated.end()), separated.end());
  return dropped;
}

}  // namespace sunder::solver
